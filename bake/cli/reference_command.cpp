#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "bake/cli/camera_options.h"
#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/interrupt.h"
#include "bake/cli/memory_limit.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/path_integration.h"
#include "bake/cli/progress.h"
#include "bake/cli/reference_checks.h"
#include "bake/cli/scene_options.h"
#include "bake/cli/stand_in.h"
#include "bake/cli/write_picture.h"
#include "bake/path_images/path_image.h"
#include "bake/reference/path_filter.h"
#include "bake/reference/reference_image.h"
#include "bake/reference/reference_receivers.h"
#include "bake/reference/write_receivers.h"
#include "formats/image/exr.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/terms.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;
using formats::Status;

struct ReferenceCommand {
    std::string scene, media, light, output, terms, texture_filter = "none";
    CameraOptions camera;
    PathIntegrationOptions paths;
    double metres_per_unit = 1, rotate_light = 0, seconds = 0;
    std::uint32_t receivers = 0, samples = 0, max_depth = 0;
    std::uint64_t seed = 0;
    float exposure = 0;
    unsigned threads = 0;
    ProgressStyle progress = ProgressStyle::automatic;
    std::vector<const CLI::Option*> picture_options;  ///< that say nothing of receivers
};

// Beside OUT.exr: OUT.var.exr.
std::string variance_path(const std::string& output) {
    return std::filesystem::path(output).replace_extension(".var.exr").string();
}

Status check_paths(const ReferenceCommand& options, std::vector<std::filesystem::path> inputs) {
    const bool table = ending_of(options.output) == ".csv";
    std::vector<OutputFile> outputs{{"--output", options.output, {".exr", ".png", ".csv"}}};
    if (!table && !options.paths.is_chosen()) {
        outputs.push_back({"the variance beside it", variance_path(options.output), {}});
    }
    inputs.insert(inputs.end(), {options.scene, options.media, options.light});
    if (auto status = check_outputs(outputs, inputs); !status) {
        return status;
    }
    if (options.texture_filter != "none" && (table || options.seconds > 0)) {
        return make_error(ErrorKind::usage, "", "--texture-filter",
                          table ? "only the paths of a picture have footprints"
                                : "footprints depend on the number of paths, which --seconds "
                                  "leaves open",
                          table ? "leave it out, or end the output's name in .exr or .png"
                                : "give --spp instead of --seconds");
    }
    if (table != (options.receivers > 0)) {
        return make_error(ErrorKind::usage, options.output, "",
                          table ? "a table needs receivers" : "receivers go into a table",
                          table
                              ? "give --receivers N, or end the name in .exr or .png for a picture"
                              : "end the name in .csv, or leave out --receivers");
    }
    for (const CLI::Option* option : options.picture_options) {
        if (table && option->count() > 0) {
            return make_error(ErrorKind::usage, "", option->get_name(),
                              "a table of receivers is no picture",
                              "leave it out; --eye says where receivers are seen from");
        }
    }
    return formats::ok_status();
}

// Nothing: textures are looked up at points.
std::unique_ptr<bake::TextureFiltering> make_filtering(const ReferenceCommand& options,
                                                       const bake::HitScene& surfaces,
                                                       std::uint32_t samples) {
    if (options.texture_filter == "none") {
        return nullptr;
    }
    bake::TextureFiltering filtering{bake::make_scene_pyramids(surfaces.scene())};
    if (!filtering.pyramids.any()) {
        return nullptr;
    }
    filtering.step = 1 / std::sqrt(static_cast<float>(samples));
    filtering.gradient_limit =
        options.texture_filter == "limited" ? 0.7f : std::numeric_limits<float>::infinity();
    filtering.extent = 2 * glm::length(surfaces.half_size());
    return std::make_unique<bake::TextureFiltering>(std::move(filtering));
}

// So that an unwritable folder is found out before the work.
Status try_to_create(const std::string& path) {
    const auto file = formats::AtomicFile::create(path);
    return file ? formats::ok_status() : Status(file.error());
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

void print_summary(const ReferenceCommand& options, const bake::Estimate& estimate) {
    const double paths =
        static_cast<double>(estimate.pixel.size()) * static_cast<double>(estimate.samples);
    print_note(fmt::format(
        "{}: {} samples for each of {} {}, {}, {:.3g} paths/s; {}", printable(options.output),
        estimate.samples, estimate.pixel.size(), options.receivers > 0 ? "receivers" : "pixels",
        format_seconds(estimate.seconds), estimate.seconds > 0 ? paths / estimate.seconds : 0.0,
        describe_noise(estimate)));
}

Status report_lost_paths(const ReferenceCommand& options, const bake::Estimate& estimate) {
    constexpr double kNoticed = 1e-4;
    const double paths =
        static_cast<double>(estimate.pixel.size()) * static_cast<double>(estimate.samples);
    const double lost = static_cast<double>(estimate.lost) / std::max(paths, 1.0);
    if (lost <= kNoticed) {
        return formats::ok_status();
    }
    return report_warnings({formats::make_warning(
        options.scene, "",
        fmt::format("{:.2g} % of the paths left a body that is not closed: what leaves through its "
                    "holes counts as bright as the rest",
                    100 * lost),
        "close the holes of its mesh")});
}

Status make_table(const ReferenceCommand& options, const bake::PathSpace& space,
                  const bake::EstimateOptions& wanted, const bake::Context& context) {
    std::optional<glm::vec3> eye;
    if (!options.camera.eye.empty()) {
        const auto point = parse_vec3("--eye", options.camera.eye);
        if (!point) {
            return point.error();
        }
        eye = {point->x, point->y, point->z};
    }
    const auto receivers =
        bake::choose_receivers(space.scene, options.receivers, options.seed, eye);
    const auto estimate = bake::estimate_receivers(space, receivers, wanted, context);
    if (!estimate) {
        return estimate.error();
    }
    if (auto status = report_lost_paths(options, *estimate); !status) {
        return status;
    }
    if (auto status = bake::write_receiver_csv(options.output, receivers, *estimate); !status) {
        return status;
    }
    print_summary(options, *estimate);
    return formats::ok_status();
}

Status make_picture(const ReferenceCommand& options, const bake::PathSpace& space,
                    const bake::EstimateOptions& wanted, const bake::Context& context) {
    const formats::Asset stand_in = make_stand_in(space.scene.surfaces.scene());
    const auto camera = make_camera(options.camera, stand_in.view());
    if (!camera) {
        return camera.error();
    }
    if (options.paths.is_chosen()) {
        return make_path_picture({options.output, options.exposure, options.samples, *camera},
                                 space, options.paths, context);
    }
    const auto image = bake::estimate_image(space, *camera, wanted, context);
    if (!image) {
        return image.error();
    }
    if (auto status = report_lost_paths(options, image->estimate); !status) {
        return status;
    }
    if (auto status = formats::write_exr(variance_path(options.output), image->variance); !status) {
        return status;
    }
    const runtime::Picture picture{image->mean.width, image->mean.height, image->mean.pixel};
    if (auto status = write_picture(options.output, picture, options.exposure); !status) {
        return status;
    }
    print_summary(options, image->estimate);
    return formats::ok_status();
}

bake::EstimateOptions estimate_options(const ReferenceCommand& options) {
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

int run(const ReferenceCommand& options) {
    const std::atomic<bool>& interrupted = catch_interrupts();
    bake::PathOptions paths;
    if (options.max_depth > 0) {
        paths.max_depth = options.max_depth;
    }
    const auto terms = formats::parse_terms(options.terms, formats::TermSet::all, "--terms");
    if (!terms) {
        return report_error(terms.error());
    }
    paths.terms = *terms;
    const MonteCarloOption monte_carlo[] = {{"--receivers", options.receivers > 0},
                                            {"--seconds", options.seconds > 0},
                                            {"--max-depth", options.max_depth > 0},
                                            {"--texture-filter", options.texture_filter != "none"},
                                            {"--seed", options.seed > 0}};
    if (auto status = check_method(options.paths, monte_carlo, paths.terms); !status) {
        return report_error(status.error());
    }
    if (auto status = check_paths(options, {}); !status) {
        return report_error(status.error());
    }
    const auto imported = open_scene(options.scene, {options.metres_per_unit, {}}, options.media);
    if (!imported) {
        return report_error(imported.error());
    }
    if (auto status = check_paths(options, imported->scene.inputs); !status) {
        return report_error(status.error());
    }
    if (auto status = check_traceable(imported->scene); !status) {
        return report_error(status.error());
    }
    if (options.paths.is_chosen()) {
        if (auto status = bake::check_path_scene(imported->scene); !status) {
            return report_error(status.error());
        }
    }
    const auto light = open_light(options.light, options.rotate_light);
    if (!light) {
        return report_error(light.error());
    }
    if (auto status = try_to_create(options.output); !status) {
        return report_error(status.error());
    }
    if (auto status = check_threads(options.threads); !status) {
        return report_error(status.error());
    }
    if (options.receivers > 0 && imported->scene.primitives.empty()) {
        return report_error(make_error(ErrorKind::usage, options.scene, "--receivers",
                                       "the scene has no vertices to choose from",
                                       "make a picture: end the name in .exr or .png"));
    }
    const auto bodies = close_bodies(imported->scene);
    if (!bodies) {
        return report_error(bodies.error());
    }
    const auto scene = bake::make_reference_scene(bodies->scene ? *bodies->scene : imported->scene,
                                                  options.threads);
    if (!scene) {
        return report_error(scene.error());
    }
    const runtime::Rotation& r = light->rotation;
    const bake::LightSampler sampler =
        bake::make_light_sampler(light->environment, glm::mat3(glm::vec3(r.x.x, r.x.y, r.x.z),
                                                               glm::vec3(r.y.x, r.y.y, r.y.z),
                                                               glm::vec3(r.z.x, r.z.y, r.z.z)));
    bake::Context context;
    context.threads = options.threads;
    context.cancel = &interrupted;
    context.on_progress = make_progress_printer(options.progress);
    const bake::EstimateOptions wanted = estimate_options(options);
    const auto filtering = make_filtering(options, scene->surfaces, wanted.samples);
    const bake::PathSpace space{*scene, sampler, paths, filtering.get()};
    const Status status =
        (options.receivers > 0 ? make_table : make_picture)(options, space, wanted, context);
    return status ? kExitSuccess : report_error(status.error());
}

void add_estimate_options(CLI::App& command, ReferenceCommand& options) {
    command
        .add_option("--receivers", options.receivers,
                    "a table instead of a picture: radiance and its standard error at N vertices, "
                    "seen as `opaline relight` sees them")
        ->transform(whole_number(1, 100000000))
        ->option_text("N");
    command
        .add_option("--spp", options.samples,
                    "paths for each pixel or receiver; default 64 for pictures, 1024 for tables, "
                    "no limit with --seconds; view rays with path-integration, default 4")
        ->transform(whole_number(1, 2000000000))
        ->option_text("N");
    command
        .add_option("--seconds", options.seconds,
                    "stop after about that time; how many samples fit differs from run to run")
        ->check(real_number(1e-3, 1e9))
        ->option_text("S");
    command
        .add_option("--max-depth", options.max_depth,
                    "at most D scattering events along a path, refraction included; default: no "
                    "limit, Russian roulette ends paths that carry little")
        ->transform(whole_number(1, 1000000000))
        ->option_text("D");
    command
        .add_option(
            "--terms", options.terms,
            "count only some of the light: " + formats::term_names(formats::TermSet::baked, ", ") +
                " (scattered once or more often in volumes) as in `opaline relight`, unscattered "
                "(straight through a body), interreflection (paths that meet a second surface or "
                "body, or a volume and a surface), emitters (light of the scene's own glowing "
                "surfaces and lights)")
        ->check(term_list())
        ->option_text("all|LIST [all]");
    command
        .add_option("--texture-filter", options.texture_filter,
                    "what textures are looked up over in pictures: none (a point: no bias), "
                    "footprint (what a path stands for among --spp: less noise), limited (less of "
                    "it where the density of directions varies, from the second scattering on)")
        ->check(CLI::IsMember({"none", "footprint", "limited"}))
        ->option_text("none|footprint|limited [none]");
    command.add_option("--seed", options.seed, "another one gives other noise")
        ->transform(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
        ->option_text("S [0]");
    command
        .add_option("--threads", options.threads,
                    "0: one per core; the result is the same for any number")
        ->transform(whole_number(0, 1024))
        ->option_text("T [0]");
}

}  // namespace

void add_reference_command(CLI::App& app, Job& job) {
    auto options = std::make_shared<ReferenceCommand>();
    CLI::App* command = app.add_subcommand(
        "reference", "Ground truth of a scene by Monte Carlo: a picture, or radiance at vertices");
    command
        ->add_option(
            "scene", options->scene,
            "the scene: .gltf or .glb; .vdb for a volume alone; .json for the volumes of a media "
            "file alone")
        ->required()
        ->option_text("SCENE");
    command->add_option("--light", options->light, light_help())->required()->option_text("ENV");
    command
        ->add_option(
            "-o,--output", options->output,
            ".exr: linear radiance; .png: tone-mapped as by `render`; beside both .var.exr, "
            "the variance of each pixel's mean; .csv: primitive,vertex,r,g,b,se_r,se_g,se_b")
        ->required()
        ->check(file_name())
        ->option_text("OUT.exr|.png|.csv");
    command
        ->add_option("--media", options->media,
                     "what translucent materials are made of; volumes of smoke or cloud")
        ->check(file_name())
        ->option_text("FILE.json");
    command
        ->add_option("--metres-per-unit", options->metres_per_unit,
                     "length of one unit of the scene file")
        ->check(real_number(kLeastUnit, kMostUnit))
        ->option_text("X [1]");
    add_path_integration_options(*command, options->paths);
    add_estimate_options(*command, *options);
    add_camera_options(*command, options->camera);
    for (const char* name :
         {"--size", "--azimuth", "--elevation", "--distance", "--target", "--up", "--fov"}) {
        options->picture_options.push_back(command->get_option(name));
    }
    command->add_option("--exposure", options->exposure, "brighter by a factor of 2^EV")
        ->check(real_number(-64, 64))
        ->option_text("EV [0]");
    command
        ->add_option("--rotate-light", options->rotate_light,
                     "turn the light about +Y, from +Z toward +X [degrees]")
        ->check(real_number(-1e6, 1e6))
        ->option_text("DEG [0]");
    add_progress_option(*command, options->progress);
    command->footer(
        "Example:\n  opaline reference scene.glb --light studio --receivers 100 -o truth.csv");
    command->callback([options, &job] { job = [options] { return run(*options); }; });
}

}  // namespace opaline::cli
