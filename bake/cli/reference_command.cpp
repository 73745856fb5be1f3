#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "bake/cli/command.h"
#include "bake/cli/draw_frames.h"
#include "bake/cli/inputs.h"
#include "bake/cli/machine_limits.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/progress.h"
#include "bake/cli/reference_options.h"
#include "bake/cli/scene_options.h"
#include "bake/lab/path_images/path_image.h"
#include "bake/reference/path_filter.h"
#include "bake/reference/reference_receivers.h"
#include "formats/image/exr.h"
#include "formats/opal/asset.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/terms.h"
#include "formats/scene.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;

// The scene's surfaces and volumes as far as a camera is placed by them (make_camera): positions
// and triangles of surfaces, corners of volumes, in the world [m].
formats::Asset make_stand_in(const formats::Scene& scene) {
    formats::Asset asset;
    for (const formats::Primitive& p : scene.primitives) {
        formats::PrimitiveRecord record;
        record.first_vertex = static_cast<std::uint32_t>(asset.position.size());
        record.vertex_count = static_cast<std::uint32_t>(p.position.size());
        record.first_index = static_cast<std::uint32_t>(asset.index.size());
        record.index_count = static_cast<std::uint32_t>(p.index.size());
        asset.primitives.push_back(record);
        for (const glm::vec3& v : p.position) {
            const glm::vec3 world(scene.to_world(v));
            asset.position.push_back({world.x, world.y, world.z});
        }
        asset.index.insert(asset.index.end(), p.index.begin(), p.index.end());
    }
    for (const formats::Volume& volume : scene.volumes) {
        formats::PrimitiveRecord record;
        record.first_vertex = static_cast<std::uint32_t>(asset.position.size());
        for (const glm::dvec3& corner : volume.density.corners()) {
            const glm::vec3 world(scene.origin + corner);
            asset.position.push_back({world.x, world.y, world.z});
        }
        record.vertex_count =
            static_cast<std::uint32_t>(asset.position.size()) - record.first_vertex;
        asset.primitives.push_back(record);
    }
    return asset;
}

// Nothing: textures are looked up at points.
std::unique_ptr<bake::TextureFiltering> make_filtering(const ReferenceOptions& options,
                                                       const bake::HitScene& surfaces,
                                                       std::uint32_t samples) {
    if (options.texture_filter == TextureFilter::none) return nullptr;
    bake::TextureFiltering filtering{bake::make_scene_pyramids(surfaces.scene())};
    if (!filtering.pyramids.any()) return nullptr;
    filtering.step = 1 / std::sqrt(static_cast<float>(samples));
    filtering.gradient_limit = options.texture_filter == TextureFilter::limited
                                   ? 0.7f
                                   : std::numeric_limits<float>::infinity();
    filtering.extent = 2 * glm::length(surfaces.half_size());
    return std::make_unique<bake::TextureFiltering>(std::move(filtering));
}

// A sun behind a smooth boundary is met by few paths or none, which says nothing of the error.
std::string describe_noise(const bake::Estimate& estimate) {
    double error = 0, sum = 0;
    for (const bake::Moments& m : estimate.pixel) {
        const glm::dvec3 variance = m.variance_of_mean();
        error += variance.x + variance.y + variance.z;
        sum += glm::dot(m.mean, m.mean);
    }
    return !(sum > 0) ? "no path met any light"
           : estimate.samples < 2
               ? "one sample does not tell its error"
               : fmt::format("relative standard error {:.2g} %", 100 * std::sqrt(error / sum));
}

void print_summary(const ReferenceOptions& options, const bake::Estimate& estimate) {
    const double paths =
        static_cast<double>(estimate.pixel.size()) * static_cast<double>(estimate.samples);
    print_note(fmt::format(
        "{}: {} samples for each of {} {}, {}, {:.3g} paths/s; {}", printable(options.output),
        estimate.samples, estimate.pixel.size(), options.receivers > 0 ? "receivers" : "pixels",
        format_seconds(estimate.seconds), estimate.seconds > 0 ? paths / estimate.seconds : 0.0,
        describe_noise(estimate)));
}

void report_lost_paths(const ReferenceOptions& options, const bake::Estimate& estimate) {
    constexpr double kNoticed = 1e-4;
    const double paths =
        static_cast<double>(estimate.pixel.size()) * static_cast<double>(estimate.samples);
    const double lost = static_cast<double>(estimate.lost) / std::max(paths, 1.0);
    if (lost <= kNoticed) return;
    require(report_warnings({formats::make_warning(
        options.scene, "",
        fmt::format("{:.2g} % of the paths left a body that is not closed: what leaves through its "
                    "holes counts as bright as the rest",
                    100 * lost),
        "close the holes of its mesh")}));
}

void make_table(const ReferenceOptions& options, const bake::PathSpace& space,
                const bake::EstimateOptions& wanted, const bake::Context& context) {
    std::optional<glm::vec3> eye;
    if (!options.camera.eye.empty()) {
        const auto point = parse_vec3("--eye", options.camera.eye);
        eye = {point.x, point.y, point.z};
    }
    const auto receivers =
        bake::choose_receivers(space.scene, options.receivers, options.seed, eye);
    const auto estimate = require(bake::estimate_receivers(space, receivers, wanted, context));
    report_lost_paths(options, estimate);
    require(bake::write_receiver_csv(options.output, receivers, estimate));
    print_summary(options, estimate);
}

// As `render` chooses it: of what stands before the background.
float exposure_of(const ReferenceOptions& options, const bake::PathSpace& space,
                  const runtime::Camera& camera, runtime::Picture picture) {
    if (options.exposure || ending_of(options.output) == ".exr") {
        return options.exposure.value_or(0.0f);
    }
    const bake::HitScene& surfaces = space.scene.surfaces;
    const runtime::CameraFrame frame = runtime::camera_frame(camera);
    const bake::RayOrigin eye{glm::dvec3(camera.eye.x, camera.eye.y, camera.eye.z) -
                              surfaces.scene().origin};
    for (std::uint32_t i = 0; surfaces.scene().volumes.empty() && i < picture.pixel.size(); ++i) {
        const std::uint32_t row = i / camera.width, column = i % camera.width;
        const formats::Vec3 ray = runtime::view_ray(camera, frame, column + 0.5, row + 0.5);
        if (!surfaces.closest_hit(eye, {ray.x, ray.y, ray.z},
                                  std::numeric_limits<float>::infinity())) {
            picture.pixel[i] = {};
        }
    }
    return note_exposure(picture);
}

void make_picture(const ReferenceOptions& options, const bake::PathSpace& space,
                  const bake::EstimateOptions& wanted, const bake::Context& context) {
    const formats::Asset stand_in = make_stand_in(space.scene.surfaces.scene());
    const auto camera = make_camera(options.camera, stand_in.view());
    if (options.by_integration()) return make_path_picture(options, camera, space, context);
    const auto image = require(bake::estimate_image(space, camera, wanted, context));
    report_lost_paths(options, image.estimate);
    require(formats::write_exr(variance_path(options.output), image.variance));
    const runtime::Picture picture{image.mean.width, image.mean.height, image.mean.pixel};
    require(write_picture(options.output, picture, exposure_of(options, space, camera, picture)));
    print_summary(options, image.estimate);
}

bake::EstimateOptions estimate_options(const ReferenceOptions& options) {
    constexpr std::uint32_t kReceiverSamples = 1024, kPixelSamples = 64;
    bake::EstimateOptions wanted;
    wanted.seed = options.seed;
    wanted.seconds = options.seconds;
    wanted.samples = options.samples > 0     ? options.samples
                     : options.seconds > 0   ? std::numeric_limits<std::uint32_t>::max() / 2
                     : options.receivers > 0 ? kReceiverSamples
                                             : kPixelSamples;
    return wanted;
}

int run(const ReferenceOptions& options) {
    const std::atomic<bool>& interrupted = catch_interrupts();
    bake::PathOptions paths;
    if (options.max_depth > 0) {
        paths.max_depth = options.max_depth;
    }
    paths.terms = require(formats::parse_terms(options.terms, formats::TermSet::all, "--terms"));
    check_light(options.light);
    check_method(options, paths.terms);
    check_reference_paths(options, {});
    const auto imported =
        open_scene(options.scene, options.import, options.media, formats::CloudDetail::fields);
    check_reference_paths(options, imported.scene.inputs);
    check_traceable(imported.scene);
    if (options.by_integration()) {
        require(bake::check_path_scene(imported.scene));
    }
    const auto light = open_light(options.light, options.rotate_light);
    // So that an unwritable folder is found out before the work.
    require(formats::AtomicFile::create(options.output));
    require(check_threads(options.threads));
    if (options.receivers > 0 && imported.scene.primitives.empty()) {
        refuse(make_error(ErrorKind::usage, options.scene, "--receivers",
                          "the scene has no vertices to choose from",
                          "make a picture: end the name in .exr or .png"));
    }
    const auto bodies = close_bodies(imported.scene);
    const auto scene = require(
        bake::make_reference_scene(bodies.scene ? *bodies.scene : imported.scene, options.threads));
    const runtime::Rotation& r = light.rotation;
    const bake::LightSampler sampler = bake::make_light_sampler(
        light.environment, glm::mat3(glm::vec3(r.x.x, r.x.y, r.x.z), glm::vec3(r.y.x, r.y.y, r.y.z),
                                     glm::vec3(r.z.x, r.z.y, r.z.z)));
    bake::Context context;
    context.threads = options.threads;
    context.cancel = &interrupted;
    context.on_progress = make_progress_printer(options.progress, "reference");
    const bake::EstimateOptions wanted = estimate_options(options);
    const auto filtering = make_filtering(options, scene.surfaces, wanted.samples);
    const bake::PathSpace space{scene, sampler, paths, filtering.get()};
    (options.receivers > 0 ? make_table : make_picture)(options, space, wanted, context);
    if (context.on_progress) context.on_progress({"reference", 1, 1});
    return kExitSuccess;
}

}  // namespace

void add_reference_command(Program& program) {
    auto [command, options] = add_command<ReferenceOptions>(
        program, "reference",
        "Ground truth of a scene by Monte Carlo: a picture, or radiance at vertices", run);
    add_reference_options(command, options);
    command.footer(
        "Example:\n  opaline reference scene.glb --light studio --receivers 100 -o truth.csv");
}

}  // namespace opaline::cli
