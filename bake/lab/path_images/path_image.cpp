#include "bake/lab/path_images/path_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bake/base/interrupted.h"
#include "bake/base/ordered_parallel.h"
#include "bake/base/stage_log.h"
#include "bake/lab/path_images/scattered_light.h"
#include "bake/lab/path_images/surface_light.h"
#include "bake/physics/path_integral/least_attenuation.h"
#include "bake/physics/phase_series.h"

namespace opaline::bake {
namespace {

using formats::TermSet;

// Nodes near density of the two lattices. Toward a sun shadows are sharp; 96 cells of a sky are
// not.
constexpr std::size_t kSunNodes = 1000000, kCellNodes = 6000;

bool same_phase(const formats::PhaseFunction& a, const formats::PhaseFunction& b) {
    return a.type == b.type && a.g == b.g && a.rms_angle == b.rms_angle && a.cosine == b.cosine &&
           a.value == b.value;
}

VolumeBox grown(VolumeBox box, double margin) {
    return {box.low - margin, box.high + margin};
}

bool is_paper(const VolumeSpace& volumes) {
    return volumes.volumes.front().volume->paper;
}

bool needs_furnace(const PathImageOptions& options, const VolumeSpace& volumes) {
    return options.renormalise && !is_paper(volumes) &&
           has_any(options.terms, TermSet::volume_multiple);
}

std::optional<double> curvature_of(const VolumeSpace& volumes) {
    const formats::PhaseFunction& phase = volumes.volumes.front().volume->phase;
    return is_paper(volumes) ? std::optional(printed_curvature(expand_phase(phase, 2).lambda[1]))
                             : std::nullopt;
}

ScatteringSpace prepare(const ReferenceScene& scene, const LightSampler& light,
                        const PathImageOptions& options, const Context& context) {
    const VolumeSpace& volumes = scene.volumes;
    ImageLights lights = make_image_lights(*light.environment, light.world_from_light);
    std::vector<glm::dvec3> suns;
    for (const ImageSun& sun : lights.suns) {
        suns.push_back(sun.direction);
    }
    const bool needs_cells = needs_furnace(options, volumes) || !lights.sky.texel.empty();
    const HitScene* const surfaces =
        scene.surfaces.scene().primitives.empty() ? nullptr : &scene.surfaces;
    ScatteringSpace space{
        volumes,
        make_bands(volumes),
        make_image_phase(volumes.volumes.front().volume->phase, is_paper(volumes)),
        std::move(lights),
        make_column_field(volumes, surfaces,
                          suns.empty() ? DepthLattice{} : make_depth_lattice(volumes, kSunNodes),
                          suns, context),
        make_column_field(
            volumes, surfaces,
            needs_cells ? make_depth_lattice(volumes, kCellNodes) : DepthLattice{},
            needs_cells ? std::span<const glm::dvec3>(sky_cells()) : std::span<const glm::dvec3>(),
            context),
        {.box = grown(density_box(volumes), voxel_edge(volumes)), .step = voxel_edge(volumes)},
        is_paper(volumes) ? options.paper_lengths : options.lengths,
        curvature_of(volumes)};
    return space;
}

/// A picture's surroundings.
struct Studio {
    const ReferenceScene& scene;
    const LightSampler& light;
    const ScatteringSpace& space;
    const FurnaceGrid* furnace;  // null: no factors
    glm::vec3 eye;
    PathImageOptions options;
};

bool has_density_beyond(const VolumeSpace& volumes, const SurfaceHit& hit, glm::vec3 direction) {
    VolumeMarch march(volumes, hit.position, direction, std::numeric_limits<float>::infinity());
    return march.next().has_value();
}

// Light that volumes scatter along a ray. x, y: its place in the picture.
glm::dvec3 scatter_along(const Studio& studio, const ViewRay& ray,
                         const std::optional<SurfaceHit>& hit, double x, double y) {
    const ScatteringSpace& space = studio.space;
    const bool once = has_any(studio.options.terms, TermSet::volume_single);
    const bool often = has_any(studio.options.terms, TermSet::volume_multiple);
    const bool paper = space.curvature.has_value();
    const PathForm form = !paper && hit && has_density_beyond(space.volumes, *hit, ray.direction)
                              ? PathForm::source
                              : PathForm::ray;
    const SkyView sky = view_sky(space.lights.sky, space.phase.density,
                                 paper                   ? space.phase.boundary
                                 : form == PathForm::ray ? space.phase.ray
                                                         : space.phase.source,
                                 glm::dvec3(ray.direction));
    glm::dvec3 sum(0);
    for (std::size_t k = 0; k < space.bands.size(); ++k) {
        const RayLight light = gather_scattered(space, ray, sky,
                                                {.band = space.bands[k],
                                                 .steps = ray.band[k],
                                                 .form = form,
                                                 .is_open = !hit.has_value(),
                                                 .often = often});
        const double factor =
            studio.furnace != nullptr && form == PathForm::ray ? studio.furnace->at(x, y, k) : 1;
        const glm::dvec3 radiance = (once ? 1.0 : 0.0) * light.once + factor * light.often;
        for (int c = 0; c < 3; ++c) {
            if (space.bands[k].channel[static_cast<std::size_t>(c)]) {
                sum[c] = radiance[c];
            }
        }
    }
    return sum;
}

glm::dvec3 passing_of(const ScatteringSpace& space, const ViewRay& ray) {
    glm::dvec3 share(1);
    for (std::size_t k = 0; k < space.bands.size(); ++k) {
        for (int c = 0; c < 3; ++c) {
            if (space.bands[k].channel[static_cast<std::size_t>(c)]) {
                share[c] = std::exp(-ray.band[k].tau);
            }
        }
    }
    return share;
}

glm::dvec3 trace_view_ray(const Studio& studio, glm::vec3 direction, double x, double y) {
    const TermSet terms = studio.options.terms;
    const auto hit = first_visible_hit(studio.scene.surfaces, studio.eye, direction);
    const ViewRay ray =
        march_view_ray(studio.space.volumes, studio.space.bands, studio.eye, direction,
                       hit ? hit->distance : std::numeric_limits<float>::infinity());
    glm::dvec3 behind(0);
    if (hit) {
        if (has_any(terms, TermSet::diffuse)) {
            behind = reflect_diffusely_once(studio.space, studio.scene.surfaces, *hit, direction);
        }
    } else if (terms == TermSet::all) {
        behind = glm::dvec3(eval_light(studio.light, direction));
    }
    glm::dvec3 radiance = behind * passing_of(studio.space, ray);
    if (!ray.is_empty() && has_any(terms, TermSet::volume_single | TermSet::volume_multiple)) {
        radiance += scatter_along(studio, ray, hit, x, y);
    }
    return radiance;
}

// Places in a pixel, evenly spread without a pattern: multiples of irrational numbers
// [Roberts2018].
glm::dvec2 place_in_pixel(std::uint32_t i) {
    const glm::dvec2 at = 0.5 + static_cast<double>(i) * glm::dvec2(0.7548776662, 0.5698402910);
    return at - glm::floor(at);
}

}  // namespace

formats::Status check_path_scene(const formats::Scene& scene) {
    const auto refuse = [&](std::string where, std::string fault, std::string remedy) {
        return formats::make_error(formats::ErrorKind::bad_input, scene.source, std::move(where),
                                   std::move(fault), std::move(remedy));
    };
    if (scene.volumes.empty()) {
        return refuse("", "path integration is for volumes, and the scene has none",
                      "leave out --method, or place a volume with --media");
    }
    for (const formats::Volume& volume : scene.volumes) {
        if (volume.paper != scene.volumes.front().paper) {
            return refuse(volume.name,
                          "path integration needs one fidelity in all volumes, and this one "
                          "differs from that of " +
                              scene.volumes.front().name,
                          "give all of them the same fidelity");
        }
        if (!volume.scattering.empty()) {
            return refuse(volume.name, "path integration needs an albedo that is alike everywhere",
                          "leave out --method, or give one albedo instead of a grid");
        }
        if (!same_phase(volume.phase, scene.volumes.front().phase)) {
            return refuse(volume.name,
                          "path integration needs one phase function in all volumes, and this one "
                          "differs from that of " +
                              scene.volumes.front().name,
                          "leave out --method, or give them the same phase function");
        }
    }
    for (const formats::Primitive& primitive : scene.primitives) {
        if (scene.materials[primitive.material].medium) {
            return refuse(primitive.name,
                          "path integration follows no light through bodies with a medium",
                          "leave out --method, or make the material opaque");
        }
    }
    return formats::ok_status();
}

bool has_paper_fidelity(const formats::Scene& scene) {
    return scene.volumes.front().paper;
}

formats::Result<PathImage> make_path_image(const ReferenceScene& scene, const LightSampler& light,
                                           const runtime::Camera& camera,
                                           const PathImageOptions& options,
                                           const Context& context) {
    const Clock::time_point start = Clock::now();
    const ScatteringSpace space = prepare(scene, light, options, context);
    const glm::vec3 eye(glm::dvec3(camera.eye.x, camera.eye.y, camera.eye.z) -
                        scene.surfaces.scene().origin);
    if (context.cancelled()) return interrupted();
    FurnaceGrid furnace;
    const bool renormalises = needs_furnace(options, scene.volumes);
    if (renormalises) {
        furnace = make_furnace_grid(space, camera, eye, context);
    }
    PathImage image;
    image.preparation_seconds = seconds_since(start);
    image.radiance = {camera.width, camera.height, {}};
    const Studio studio{scene, light, space, renormalises ? &furnace : nullptr, eye, options};
    const runtime::CameraFrame frame = runtime::camera_frame(camera);
    const std::size_t pixels = std::size_t{camera.width} * camera.height;
    for_each_block_in_order(
        pixels, 32, context,
        [&](Range range) {
            std::vector<formats::Rgb> block;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                glm::dvec3 sum(0);
                for (std::uint32_t r = 0; r < options.rays; ++r) {
                    const glm::dvec2 at =
                        glm::dvec2(i % camera.width, i / camera.width) + place_in_pixel(r);
                    const auto d = runtime::view_ray(camera, frame, at.x, at.y);
                    sum += trace_view_ray(studio, {d.x, d.y, d.z}, at.x, at.y);
                }
                sum /= options.rays;
                block.push_back({static_cast<float>(sum.x), static_cast<float>(sum.y),
                                 static_cast<float>(sum.z)});
            }
            return block;
        },
        [&](Range range, const std::vector<formats::Rgb>& block) {
            image.radiance.pixel.insert(image.radiance.pixel.end(), block.begin(), block.end());
            if (context.on_progress) {
                context.on_progress({"path integration", range.end, pixels});
            }
        });
    if (context.cancelled()) return interrupted();
    image.seconds = seconds_since(start);
    return image;
}

}  // namespace opaline::bake
