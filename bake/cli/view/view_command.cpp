#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/picture_options.h"
#include "bake/cli/view/view_script.h"
#include "bake/cli/view/view_session.h"
#include "runtime/terms.h"

namespace opaline::cli {
namespace {

struct ViewCommand {
    ViewState begin;
    std::string terms, script;
    std::vector<std::string> emitters;
    CameraOptions camera;
    double rotate_light = 0;
};

std::vector<ScriptStep> read_steps(const std::string& path) {
    if (path.empty()) return {};
    const auto file = require(formats::FileBytes::open(path));
    const auto bytes = file.bytes();
    return require(parse_script({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path));
}

// What the options say of the file; the window reads it again, on its own thread.
void apply_to_file(const ViewCommand& options, ViewState& state) {
    const auto asset = require(open_asset(state.file));
    const formats::AssetView& view = asset.loaded.view;
    require(runtime::check_terms(view, state.terms, state.file));
    const auto emitters = require(parse_emitters(view.emitters, options.emitters));
    for (std::uint32_t e = 0; e < view.emitters.size(); ++e) {
        set_emitter(state, std::string(view.emitters.name(e)), emitters[e]);
    }
    const auto camera = make_camera(options.camera, view);
    state.width = camera.width;
    state.height = camera.height;
    state.fov = camera.fov_y;
    if (!frames_object(options.camera)) {
        state.viewpoint = Viewpoint{camera.eye, camera.target, camera.up};
    }
}

int run(const ViewCommand& options) {
    const auto steps = read_steps(options.script);
    ViewState state = options.begin;
    check_light(state.light);
    state.terms = require(formats::parse_terms(options.terms, formats::TermSet::baked, "--terms"));
    rotate_light_to(state, options.rotate_light);
    apply_to_file(options, state);
    return run_view(state, steps, options.script);
}

}  // namespace

void add_view_command(Program& program) {
    auto [command, options] =
        add_command<ViewCommand>(program, "view", "Show an .opal file in a window", run);
    options.camera.size = "1280x800";
    ViewState& begin = options.begin;
    add_asset_argument(command, begin.file);
    command.add("other", "OTHER.opal", file_name(begin.other),
                "a second one, shown right of a split");
    command.add("--light", "ENV [studio]", text(begin.light), light_help());
    command.add("--script", "FILE", file_name(options.script),
                "carry out the commands of a file, one a line; then the window stays open");
    add_camera_options(command, options.camera);
    add_emitter_option(command, options.emitters);
    add_time_option(command, begin.time);
    add_look_options(command, {options.rotate_light, options.terms, begin.exposure, begin.tone_map,
                               begin.coefficients});
    command.footer(
        "Drag to orbit, with the right button to pan; the wheel zooms. R frames the object, L "
        "levels\n"
        "the horizon, Tab hides the controls. Drop an .opal file, or an .exr or .hdr light. Files "
        "that\n"
        "change on disk are read again. Each screenshot prints the `opaline render` that makes the "
        "same\n"
        "picture. In motion pictures have fewer samples. Nothing is remembered from one time to "
        "the next.\n\n"
        "Commands of a script:\n" +
        script_help() +
        "What follows a # is left out. Words with blanks stand \"in quotes\". An error ends the "
        "program.\n\n"
        "Example:\n  opaline view scene.opal --light sky:3,35");
}

}  // namespace opaline::cli
