#include "runtime/picture/software_renderer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/normal_maps/turned_light.h"
#include "runtime/parallel.h"
#include "runtime/picture/layer_pass.h"
#include "runtime/picture/picture.h"
#include "runtime/picture/volume_pass.h"
#include "runtime/surface.h"
#include "runtime/texture.h"

namespace opaline::runtime {
namespace {

using formats::AssetView;
using formats::ErrorKind;
using formats::Float2;
using formats::PrimitiveRecord;
using formats::Rgb;

// Everything that the bands share, read-only.
struct Job {
    const AssetView& asset;
    std::span<const Rgb> radiance;
    const formats::Environment& environment;
    const Rotation& rotation;
    const Camera& camera;
    CameraFrame frame;
    SampleGrid grid;
    std::uint32_t supersampling = 1;
    std::uint32_t band_rows = 1;  ///< samples
    std::vector<PicturePass> passes;
    std::vector<GridVertex> vertices;
    std::vector<GridTriangle> triangles;
    std::vector<std::vector<std::uint32_t>> triangles_of_band;
    std::vector<SurfaceMaterial> materials;  // of each primitive
    LitVolumes volumes;
    const LayerLight* layers = nullptr;
    bool shows_sky = true;
    TurnedLights turned;
};

// The limit keeps sums of samples finite.
float tame(float value) {
    return value > 0.0f ? std::min(value, 1e35f) : 0.0f;
}
Rgb tame(Rgb c) {
    return {tame(c.r), tame(c.g), tame(c.b)};
}

template <class T>
T interpolate(std::span<const T> values, const std::array<std::uint32_t, 3>& vertex,
              const std::array<float, 3>& weight) {
    return weight[0] * values[vertex[0]] + weight[1] * values[vertex[1]] +
           weight[2] * values[vertex[2]];
}

Float2 interpolate_texcoord(const Job& job, const GridTriangle& triangle,
                            const std::array<float, 3>& weight) {
    Float2 uv;
    if (job.asset.texcoord.empty()) return uv;
    for (std::size_t k = 0; k < 3; ++k) {
        const Float2 at = job.asset.texcoord[triangle.vertex[k]];
        uv = {uv.x + weight[k] * at.x, uv.y + weight[k] * at.y};
    }
    return uv;
}

formats::Vec3 unit_or_zero(formats::Vec3 v) {
    const float norm = length(v);
    return norm > 0 ? (1 / norm) * v : formats::Vec3{};
}

// How a sample is seen, with the interpolated normal: Fresnel's factors change too steeply toward
// grazing views to be interpolated themselves.
ViewOfReceiver view_at(const Job& job, const PrimitiveRecord& primitive,
                       const GridTriangle& triangle, const std::array<float, 3>& weight) {
    return view_receiver(primitive, interpolate(job.asset.position, triangle.vertex, weight),
                         unit_or_zero(interpolate(job.asset.normal, triangle.vertex, weight)),
                         job.camera.eye);
}

void set_openness(const Job& job, const GridTriangle& triangle, const std::array<float, 3>& weight,
                  SurfacePoint& point) {
    formats::Vec3 axis;
    float open = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const formats::Openness openness = job.asset.openness[triangle.vertex[k]];
        axis = axis + weight[k] * formats::open_axis(openness);
        open += weight[k] * formats::open_fraction(openness);
    }
    point.open_axis = unit_or_zero(axis);
    point.open_fraction = open;
}

formats::DecodedTangent interpolate_tangent(const Job& job, const GridTriangle& triangle,
                                            const std::array<float, 3>& weight) {
    formats::DecodedTangent sum;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto at = formats::decode_tangent(job.asset.normal_maps.tangent[triangle.vertex[k]]);
        sum = {sum.direction + weight[k] * at.direction, sum.sign + weight[k] * at.sign};
    }
    return sum;
}

// What a normal map changes: the view, and the light of diffuse surfaces with one side's row.
void apply_normal_map(const Job& job, const formats::NormalMapRecord& map,
                      const GridTriangle& triangle, const std::array<float, 3>& weight, Float2 uv,
                      SurfacePoint& point) {
    const formats::Vec3 normal =
        unit_or_zero(interpolate(job.asset.normal, triangle.vertex, weight));
    const formats::Vec3 mapped =
        mapped_normal(job.asset, map, uv, normal, interpolate_tangent(job, triangle, weight));
    if (const TurnedLight* const light = job.turned.of(triangle.primitive)) {
        const bool is_sheet =
            job.asset.primitives[triangle.primitive].shading == formats::Shading::sheet;
        const float side = is_sheet && point.view.is_turned ? -1.0f : 1.0f;  // that is seen
        point.radiance = turn_light(*light, point.radiance, side * normal, side * mapped);
    }
    point.view = view_mapped(point.view, mapped);
}

SurfacePoint point_at(const Job& job, const GridTriangle& triangle,
                      const std::array<float, 3>& weight) {
    const SurfaceMaterial& material = job.materials[triangle.primitive];
    const PrimitiveRecord& primitive = *material.primitive;
    const Float2 uv = interpolate_texcoord(job, triangle, weight);
    SurfacePoint point;
    point.radiance = interpolate(job.radiance, triangle.vertex, weight);
    point.base_color = interpolate(job.asset.base_color, triangle.vertex, weight);
    if (primitive.base_color_image != formats::kNoImage && !job.asset.texcoord.empty()) {
        point.base_color =
            point.base_color * sample_image_linear(job.asset.images[primitive.base_color_image], uv,
                                                   primitive.wrap_u, primitive.wrap_v);
    }
    const bool is_glossy = material.gloss != nullptr || material.lobe.is_glossy;
    const auto* const map = job.asset.normal_maps.of(triangle.primitive);
    const bool is_mapped_sheet = map != nullptr && primitive.shading == formats::Shading::sheet;
    if (is_glossy || is_mapped_sheet || primitive.shading == formats::Shading::translucent) {
        point.view = view_at(job, primitive, triangle, weight);
    }
    if (map != nullptr) {
        apply_normal_map(job, *map, triangle, weight, uv, point);
    }
    set_own_light(job.asset, material, uv, point);
    if (is_glossy) set_openness(job, triangle, weight, point);
    if (material.gloss != nullptr) set_gloss_factors(job.asset, material, uv, point);
    return point;
}

std::array<float, 3> weights_of(const std::array<double, 3>& e) {
    const double scale = 1.0 / (e[0] + e[1] + e[2]);
    return {static_cast<float>(e[0] * scale), static_cast<float>(e[1] * scale),
            static_cast<float>(e[2] * scale)};
}

// Empty where the triangle's surface is whole.
SampleTest make_sample_test(const Job& job, const GridTriangle& triangle) {
    const formats::HoleRecord* const hole = job.asset.holes.of(triangle.primitive);
    if (hole == nullptr) return {};
    return [&job, &triangle, hole](const std::array<double, 3>& edges, std::uint32_t column,
                                   std::uint32_t row) {
        const std::array<float, 3> weight = weights_of(edges);
        const std::span<const float> alphas = job.asset.holes.vertex_alpha;
        const float vertex_alpha =
            alphas.empty() ? 1.0f : interpolate(alphas, triangle.vertex, weight);
        const Float2 uv = interpolate_texcoord(job, triangle, weight);
        const float cosine =
            hole->clear == 0
                ? 1.0f
                : std::abs(view_at(job, job.asset.primitives[triangle.primitive], triangle, weight)
                               .cosine);
        return sees_surface(*hole, alpha_at(job.asset, *hole, uv, vertex_alpha),
                            {column, row, triangle.vertex[2], cosine});
    };
}

Rgb shade_triangle(const Job& job, const GridTriangle& triangle, double x, double y) {
    const EdgeFunctions edges =
        edge_functions({job.vertices[triangle.vertex[0]], job.vertices[triangle.vertex[1]],
                        job.vertices[triangle.vertex[2]]});
    const std::array<float, 3> weight = weights_of(edges.at(x, y));
    return tame(shade_surface(job.materials[triangle.primitive], point_at(job, triangle, weight)));
}

void draw_surfaces(const Job& job, std::uint32_t number, Samples& samples) {
    for (const std::uint32_t t : job.triangles_of_band[number]) {
        draw_triangle(samples.band, t, job.triangles[t], job.vertices, job.grid,
                      make_sample_test(job, job.triangles[t]));
    }
    samples.for_each([&](std::size_t i, std::uint32_t column, std::uint32_t row) {
        const std::uint32_t seen = samples.band.triangle[i];
        if (seen == Band::kNothing) return;
        samples.color[i] = shade_triangle(job, job.triangles[seen], column + 0.5, row + 0.5);
    });
}

void draw_background(const Job& job, Samples& samples) {
    samples.for_each([&](std::size_t i, std::uint32_t column, std::uint32_t row) {
        if (samples.band.inverse_distance[i] > 0) return;
        const formats::Vec3 ray =
            view_ray(job.camera, job.frame, (column + 0.5) / job.supersampling,
                     (row + 0.5) / job.supersampling);
        samples.color[i] =
            tame(formats::sample_radiance(job.environment, job.rotation.light_from_world(ray)));
    });
}

void draw_pass(PicturePass pass, const Job& job, std::uint32_t number, Samples& samples) {
    switch (pass) {
        case PicturePass::surfaces:
            return draw_surfaces(job, number, samples);
        case PicturePass::background:
            return draw_background(job, samples);
        case PicturePass::layers:
            return draw_layers({{*job.layers, job.environment, job.rotation, job.shows_sky},
                                job.camera,
                                job.frame,
                                job.supersampling},
                               samples.band, {samples.color, samples.sheet});
        case PicturePass::volumes:
            return draw_volumes(
                {job.volumes, job.camera, job.frame, job.supersampling, job.layers, samples.sheet},
                samples.band, samples.color);
    }
}

void render_band(const Job& job, std::uint32_t number, Picture& picture) {
    Samples samples;
    const std::uint32_t first = number * job.band_rows;
    reset_band(samples.band, first, std::min(job.band_rows, job.grid.rows - first),
               job.grid.columns);
    samples.color.assign(samples.band.triangle.size(), Rgb{});
    if (job.layers != nullptr && job.volumes.light != nullptr) {
        samples.sheet.resize(samples.color.size());
    }
    for (const PicturePass pass : job.passes) {
        draw_pass(pass, job, number, samples);
    }
    resolve_samples(samples, job.supersampling, picture);
}

void sort_into_bands(Job& job) {
    job.triangles_of_band.resize((job.grid.rows + job.band_rows - 1) / job.band_rows);
    for (std::uint32_t t = 0; t < job.triangles.size(); ++t) {
        const GridTriangle& triangle = job.triangles[t];
        for (std::uint32_t b = triangle.first_row / job.band_rows;
             b <= triangle.last_row / job.band_rows; ++b) {
            job.triangles_of_band[b].push_back(t);
        }
    }
}

}  // namespace

formats::Result<Picture> render_software(const AssetView& asset, std::span<const Rgb> radiance,
                                         const formats::Environment& environment,
                                         const Rotation& rotation, const Camera& camera,
                                         const SoftwareOptions& options) {
    if (const auto status = check_camera(camera, options.supersampling); !status) {
        return status.error();
    }
    if (radiance.size() != asset.position.size()) {
        return formats::make_error(ErrorKind::usage, {}, "radiance",
                                   "found " + std::to_string(radiance.size()) +
                                       " values, expected one for each of " +
                                       std::to_string(asset.position.size()) + " vertices");
    }
    const bool has_volumes = options.volumes != nullptr && !asset.volumes.empty();
    if (has_volumes && options.volumes->part.size() != asset.volumes.records.size()) {
        return formats::make_error(ErrorKind::usage, {}, "light of volumes",
                                   "found " + std::to_string(options.volumes->part.size()) +
                                       ", expected one for each of " +
                                       std::to_string(asset.volumes.records.size()) + " volumes");
    }
    auto picture = make_picture(camera.width, camera.height);
    if (!picture) return picture;
    const std::uint32_t s = options.supersampling;
    const SampleGrid grid{camera.width * s, camera.height * s,
                          static_cast<double>(camera.near_plane)};
    Job job{.asset = asset,
            .radiance = radiance,
            .environment = environment,
            .rotation = rotation,
            .camera = camera,
            .frame = camera_frame(camera),
            .grid = grid,
            .supersampling = s,
            .band_rows = rows_of_band(grid, s),
            .passes = list_passes(options.background, has_volumes, options.layers != nullptr),
            .vertices = {},
            .triangles = {},
            .triangles_of_band = {},
            .materials = {},
            .volumes = {},
            .layers = options.layers,
            .shows_sky = options.background,
            .turned = {}};
    if (options.lights) {
        job.turned =
            make_turned_lights(*options.lights, asset.primitives, asset.normal_maps.record);
    }
    if (has_volumes) job.volumes = light_volumes(asset.volumes, *options.volumes);
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        job.materials.push_back(
            surface_material(asset, p, formats::TermSet::all, options.specular, options.emitters));
    }
    job.vertices = project_vertices(asset.position, camera, grid);
    job.triangles = select_triangles(asset, job.vertices, grid);
    sort_into_bands(job);
    const auto bands = static_cast<std::uint32_t>(job.triangles_of_band.size());
    for_ranges(bands, 1, options.threads, [&](std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t band = first; band < end; ++band) {
            render_band(job, band, *picture);
        }
    });
    return picture;
}

}  // namespace opaline::runtime
