#include <fmt/core.h>

#include <memory>
#include <optional>

#include "bake/base/stage_log.h"
#include "bake/cli/command.h"
#include "bake/cli/draw_frames.h"
#include "bake/cli/error_map.h"
#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/picture_options.h"
#include "bake/cli/progress.h"
#include "bake/encode/shorten_rows.h"
#include "formats/opal/terms.h"
#include "runtime/shade.h"

namespace opaline::cli {
namespace {

struct RenderCommand {
    std::string path, light = "studio", terms;
    std::vector<std::string> emitters;
    CameraOptions camera;
    FrameOptions frame;
    double rotate_light = 0;
    double time = 0;                  ///< [s]
    std::optional<double> time_step;  ///< from frame to frame [s]
    std::optional<double> turn;       ///< [degrees]
    std::optional<std::uint32_t> coefficients;
    ProgressStyle progress = ProgressStyle::automatic;
    double error_white = 0;  ///< errors by receiver in place of light, where it is above 0
};

// Of options that set frames apart.
void check_motion(const RenderCommand& options, const formats::AssetView& view) {
    const char* const one = "there is one frame only";
    if (options.turn && options.frame.frames == 1) {
        refuse_usage("--turn", one, "give --frames, or --azimuth for another side");
    }
    if (options.time_step && options.frame.frames == 1) {
        refuse_usage("--time-step", one, "give --frames, or --time for another time");
    }
    if (options.time_step && view.clouds.empty()) {
        refuse_usage("--time-step", "the file has no cloud layer, and nothing else moves",
                     "leave it out: --frames alone turns the camera");
    }
}

// All frames, or those of one time.
void draw_at(const RenderCommand& options, const formats::AssetView& view, const OpenedLight& light,
             const runtime::Camera& camera, Shown shown, double time, std::uint32_t end,
             Drawing& drawing) {
    const LightWithLayers layers = light_layers_of(view, light, time, options.frame.threads);
    if (layers.layers) print_seconds(options.frame, "layer light", layers.seconds);
    if (options.frame.stats && layers.parts) {
        fmt::print("{:<16} {}\n", "light points", layers.parts->at_point.size());
    }
    const auto start = bake::Clock::now();
    const PictureLight picture_light{light, layers,
                                     project_parts(view, layers, light, options.frame.threads)};
    print_seconds(options.frame, "light vector", bake::seconds_since(start));
    draw_frames(options.frame, view, picture_light, camera, shown, end, drawing);
}

// The errors by receiver in place of light.
void draw_errors(const RenderCommand& options, const OpenedAsset& asset) {
    const auto errors = require(stored_errors(asset, options.path));
    const auto camera = make_camera(options.camera, asset.loaded.view);
    const ErrorMap map =
        make_error_map(asset.loaded.view, errors, static_cast<float>(options.error_white));
    RenderCommand plain = options;
    plain.frame.exposure = 0;
    plain.frame.tone_map = runtime::ToneMap::none;
    Drawing drawing;
    draw_at(plain, map.view_of(asset.loaded.view), error_map_light(), camera, {}, 0,
            options.frame.frames, drawing);
}

int run(const RenderCommand& given) {
    RenderCommand options = given;
    options.frame.turn = given.turn.value_or(given.time_step ? 0 : 360);
    options.frame.on_progress = make_progress_printer(given.progress, "render");
    std::vector<OutputFile> outputs;
    for (std::uint32_t frame = 0; frame < options.frame.frames; ++frame) {
        outputs.push_back({"--output", frame_path(options.frame, frame), {".png", ".exr"}});
    }
    const std::filesystem::path inputs[] = {options.path, options.light};
    require(check_outputs(outputs, inputs));
    const auto terms =
        require(formats::parse_terms(options.terms, formats::TermSet::baked, "--terms"));
    check_light(options.light);
    const auto asset = require(open_asset(options.path));
    if (options.error_white > 0) {
        draw_errors(options, asset);
        return kExitSuccess;
    }
    formats::AssetView view = asset.loaded.view;
    bake::ShortRows short_rows;
    if (options.coefficients) {
        short_rows = require(bake::shorten_rows(view, *options.coefficients));
        view = short_rows.view_of(view);
    }
    require(runtime::check_terms(view, terms, options.path));
    const auto emitters = require(parse_emitters(view.emitters, options.emitters));
    check_motion(options, view);
    const auto camera = make_camera(options.camera, view);
    const auto light = open_light(options.light, options.rotate_light);
    const std::uint32_t frames = options.frame.frames;
    const std::uint32_t step = options.time_step ? 1 : frames;  // frames of one time
    Drawing drawing;
    while (drawing.frames < frames) {
        const double time = options.time + options.time_step.value_or(0) * drawing.frames;
        draw_at(options, view, light, camera, show_terms(terms, view, emitters), time,
                drawing.frames + step, drawing);
    }
    if (options.frame.on_progress) options.frame.on_progress({"render", 1, 1});
    if (options.frame.stats) {
        fmt::print("{:<16} {}\n", "frames", frames);
        fmt::print("{:<16} {}\n", "draw per frame", format_seconds(drawing.seconds / frames));
    }
    return kExitSuccess;
}

}  // namespace

void add_render_command(Program& program) {
    auto [command, options] = add_command<RenderCommand>(
        program, "render", "Make pictures of an .opal file, headless", run);
    add_asset_argument(command, options.path);
    command.add("--light", "ENV [studio]", text(options.light), light_help());
    command
        .add("-o,--output", "OUT.png|.exr", file_name(options.frame.output),
             ".png: tone-mapped, sRGB; .exr: linear radiance")
        .required();
    add_emitter_option(command, options.emitters);
    add_camera_options(command, options.camera);
    command.add("--backend", "gl|cpu [gl, else cpu]",
                one_of(options.frame.backend, {{"gl", Backend::gl}, {"cpu", Backend::cpu}}),
                "gl: OpenGL 4.5 through EGL; cpu: software");
    add_time_option(command, options.time);
    command.add("--frames", "N [1]", whole_number(options.frame.frames, 1, 9999),
                "N pictures OUT-0001.png ...: a turntable, once around the target, or with "
                "--time-step a film");
    command.add("--time-step", "S", real_number(options.time_step, -1e9, 1e9),
                "from frame to frame cloud layers are S later: their wind moves them, and their "
                "own frames [s]");
    command.add("--turn", "DEG [360, with --time-step 0]", real_number(options.turn, -1e6, 1e6),
                "what all frames together turn the camera around the target by [degrees]");
    add_look_options(command, {options.rotate_light, options.terms, options.frame.exposure,
                               options.frame.tone_map, options.coefficients});
    command.add(
        "--receiver-errors", "E", real_number(options.error_white, 1e-6, 10),
        "show the errors of rows that `bake --receiver-errors` stored in place of light: black for "
        "0, then red, yellow, and white from E on; options of light and exposure change nothing");
    add_threads_option(command, options.frame.threads, "0: one per core");
    command.add_flag("--stats", options.frame.stats, "print timings");
    add_progress_option(command, options.progress);
    command.group(
        {{"", {"--light", "--rotate-light", "--output", "--size", "--exposure"}},
         {"Camera",
          {"--eye", "--azimuth", "--elevation", "--distance", "--target", "--up", "--fov"}},
         {"Frames", {"--frames", "--time", "--time-step", "--turn"}},
         {"What is shown",
          {"--emitter", "--terms", "--tone-map", "--coefficients", "--receiver-errors"}}},
        "How");
    command.footer(
        "A cloud layer lights the file's meshes and volumes as it is seen from the centre of "
        "their\n"
        "bounds, those that stand far apart from several points.\n"
        "A layer alone is seen from 1.7 m above the ground; --elevation 20 looks down on it\n"
        "from above, --azimuth 140 toward the sun of sky:T,EL.\n"
        "--frames 48 --time-step 60 shows 48 minutes of it.\n\n"
        "Example:\n  opaline render scene.opal --light sky:3,35 --rotate-light 90 -o scene.png");
}

}  // namespace opaline::cli
