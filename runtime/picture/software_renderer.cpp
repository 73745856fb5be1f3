#include "runtime/picture/software_renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <thread>

#include "runtime/picture/band.h"
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
    std::span<const Rgb> irradiance;
    const formats::Environment& environment;
    const Rotation& rotation;
    const Camera& camera;
    CameraFrame frame;
    SampleGrid grid;
    std::uint32_t supersampling = 1;
    std::vector<GridVertex> vertices;
    std::vector<GridTriangle> triangles;
    std::vector<std::vector<std::uint32_t>> triangles_of_band;
};

// NaN fails the comparison and becomes 0; the limit keeps sums of samples finite.
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

Rgb shade_surface(const Job& job, const GridTriangle& triangle, double x, double y) {
    const EdgeFunctions edges =
        edge_functions({job.vertices[triangle.vertex[0]], job.vertices[triangle.vertex[1]],
                        job.vertices[triangle.vertex[2]]});
    const auto e = edges.at(x, y);
    const double scale = 1.0 / (e[0] + e[1] + e[2]);
    const std::array<float, 3> weight{static_cast<float>(e[0] * scale),
                                      static_cast<float>(e[1] * scale),
                                      static_cast<float>(e[2] * scale)};
    Rgb radiance = interpolate(job.irradiance, triangle.vertex, weight) *
                   interpolate(job.asset.base_color, triangle.vertex, weight);
    const PrimitiveRecord& primitive = job.asset.primitives[triangle.primitive];
    if (primitive.base_color_image != formats::kNoImage && !job.asset.texcoord.empty()) {
        Float2 uv;
        for (std::size_t k = 0; k < 3; ++k) {
            const Float2 at = job.asset.texcoord[triangle.vertex[k]];
            uv = {uv.x + weight[k] * at.x, uv.y + weight[k] * at.y};
        }
        radiance = radiance * sample_image_linear(job.asset.images[primitive.base_color_image], uv,
                                                  primitive.wrap_u, primitive.wrap_v);
    }
    return tame(radiance);
}

Rgb shade_sample(const Job& job, const Band& band, std::uint32_t column, std::uint32_t row) {
    const std::uint32_t number =
        band.triangle[std::size_t{row - band.first_row} * band.columns + column];
    const double x = column + 0.5, y = row + 0.5;
    if (number != Band::kNothing) return shade_surface(job, job.triangles[number], x, y);
    const formats::Vec3 ray =
        view_ray(job.camera, job.frame, x / job.supersampling, y / job.supersampling);
    return tame(formats::sample_radiance(job.environment, job.rotation.light_from_world(ray)));
}

void resolve_band(const Job& job, const Band& band, Picture& picture) {
    const std::uint32_t s = job.supersampling;
    const float share = 1.0f / static_cast<float>(s * s);
    for (std::uint32_t y = band.first_row / s; y < (band.first_row + band.rows) / s; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            Rgb sum;
            for (std::uint32_t j = 0; j < s; ++j) {
                for (std::uint32_t i = 0; i < s; ++i) {
                    sum = sum + shade_sample(job, band, x * s + i, y * s + j);
                }
            }
            picture.pixel[std::size_t{y} * picture.width + x] = share * sum;
        }
    }
}

constexpr std::uint32_t kBandPixels = 16;  ///< rows of pixels a thread works on at once

void render_band(const Job& job, std::uint32_t number, Band& band, Picture& picture) {
    const std::uint32_t height = kBandPixels * job.supersampling;
    const std::uint32_t first = number * height;
    reset_band(band, first, std::min(height, job.grid.rows - first), job.grid.columns);
    for (const std::uint32_t t : job.triangles_of_band[number]) {
        draw_triangle(band, t, job.triangles[t], job.vertices, job.grid);
    }
    resolve_band(job, band, picture);
}

}  // namespace

formats::Status check_camera(const Camera& camera, std::uint32_t supersampling) {
    const auto refuse = [](const std::string& where, const std::string& fault,
                           const std::string& remedy) {
        return formats::make_error(ErrorKind::usage, {}, where, fault, remedy);
    };
    if (camera.width < 1 || camera.height < 1 || camera.width > kMaxPictureSize ||
        camera.height > kMaxPictureSize) {
        return refuse("picture size",
                      "found " + std::to_string(camera.width) + "x" +
                          std::to_string(camera.height) + ", expected 1 to " +
                          std::to_string(kMaxPictureSize) + " pixels on each side",
                      "choose another size");
    }
    if (supersampling < 1 || supersampling > 8) {
        return refuse("supersampling",
                      "found " + std::to_string(supersampling) + ", expected 1 to 8",
                      "3 is a good choice");
    }
    if (!(camera.fov_y > 0.0f && camera.fov_y < 180.0f)) {
        return refuse("field of view",
                      "found " + std::to_string(camera.fov_y) +
                          " degrees, expected more than 0 and less than 180",
                      "40 is a good choice");
    }
    const formats::Vec3 sum = camera.eye + camera.target + camera.up;
    if (!std::isfinite(sum.x) || !std::isfinite(sum.y) || !std::isfinite(sum.z) ||
        !std::isfinite(camera.near_plane) || !(camera.near_plane > 0.0f)) {
        return refuse("camera", "a position is not finite or the near plane is not above 0",
                      "give finite coordinates");
    }
    return formats::ok_status();
}

formats::Result<Picture> render_software(const AssetView& asset, std::span<const Rgb> irradiance,
                                         const formats::Environment& environment,
                                         const Rotation& rotation, const Camera& camera,
                                         const SoftwareOptions& options) {
    if (const auto status = check_camera(camera, options.supersampling); !status) {
        return status.error();
    }
    if (irradiance.size() != asset.position.size()) {
        return formats::make_error(ErrorKind::usage, {}, "irradiance",
                                   "found " + std::to_string(irradiance.size()) +
                                       " values, expected one for each of " +
                                       std::to_string(asset.position.size()) + " vertices");
    }
    const std::uint32_t s = options.supersampling;
    Job job{asset,
            irradiance,
            environment,
            rotation,
            camera,
            camera_frame(camera),
            SampleGrid{camera.width * s, camera.height * s, static_cast<double>(camera.near_plane)},
            s,
            {},
            {},
            {}};
    job.vertices = project_vertices(asset.position, camera, job.grid);
    job.triangles = select_triangles(asset, job.vertices, job.grid);

    const std::uint32_t band_rows = kBandPixels * s;
    const std::uint32_t bands = (job.grid.rows + band_rows - 1) / band_rows;
    job.triangles_of_band.resize(bands);
    for (std::uint32_t t = 0; t < job.triangles.size(); ++t) {
        const GridTriangle& triangle = job.triangles[t];
        for (std::uint32_t b = triangle.first_row / band_rows; b <= triangle.last_row / band_rows;
             ++b) {
            job.triangles_of_band[b].push_back(t);
        }
    }

    Picture picture{camera.width, camera.height, {}};
    picture.pixel.resize(std::size_t{camera.width} * camera.height);
    std::atomic<std::uint32_t> next{0};
    const auto work = [&] {
        Band band;
        for (std::uint32_t b = next++; b < bands; b = next++) {
            render_band(job, b, band, picture);
        }
    };
    const std::uint32_t wanted =
        options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::thread> helpers;
    for (std::uint32_t t = 1; t < std::min(wanted, bands); ++t) {
        helpers.emplace_back(work);
    }
    work();
    for (std::thread& helper : helpers) {
        helper.join();
    }
    return picture;
}

}  // namespace opaline::runtime
