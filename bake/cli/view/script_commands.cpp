#include "bake/cli/view/script_commands.h"

#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "bake/cli/view/orbit_camera.h"
#include "bake/cli/view/view_script.h"
#include "formats/opal/terms.h"

namespace opaline::cli {
namespace {

using Words = std::span<const std::string>;
using What = decltype(ScriptStep::what);

What change(StateChange what) {
    return {std::move(what)};
}

constexpr double kMostDegrees = 1e6;

std::optional<What> parse_orbit(Words words) {
    const auto by = numbers_in(words, 2, -kMostDegrees, kMostDegrees);
    if (!by) return {};
    return change([v = *by](ViewState& state) {
        state.viewpoint = orbit_level(*state.viewpoint, v[0], v[1]);
    });
}

std::optional<What> parse_turn(Words words) {
    const auto by = numbers_in(words, 4, -10, 10);
    if (!by) return {};
    return change([v = *by](ViewState& state) {
        state.viewpoint = turn_ball(*state.viewpoint, {v[0], v[1]}, {v[2], v[3]});
    });
}

std::optional<What> parse_pan(Words words) {
    const auto by = numbers_in(words, 2, -1e3, 1e3);
    if (!by) return {};
    return change([v = *by](ViewState& state) {
        state.viewpoint = pan(*state.viewpoint, state.fov, v[0], v[1]);
    });
}

std::optional<What> parse_zoom(Words words) {
    const auto by = numbers_in(words, 1, 1e-6, 1e6);
    if (!by) return {};
    return change(
        [v = *by](ViewState& state) { state.viewpoint = zoom(*state.viewpoint, 1 / v[0]); });
}

std::optional<What> parse_level(Words words) {
    if (!words.empty()) return {};
    return change([](ViewState& state) { state.viewpoint = level(*state.viewpoint); });
}

std::optional<What> parse_frame(Words words) {
    if (!words.empty()) return {};
    return change([](ViewState& state) { state.viewpoint.reset(); });
}

std::optional<What> parse_rotate_light(Words words) {
    const auto to = numbers_in(words, 1, -kMostDegrees, kMostDegrees);
    if (!to) return {};
    return change([v = *to](ViewState& state) { rotate_light_to(state, v[0]); });
}

std::optional<What> parse_exposure(Words words) {
    if (words.size() == 1 && words[0] == "auto") {
        return change([](ViewState& state) { state.exposure.reset(); });
    }
    const auto to = numbers_in(words, 1, -64, 64);
    if (!to) return {};
    return change([v = *to](ViewState& state) { state.exposure = static_cast<float>(v[0]); });
}

std::optional<What> parse_tone_map(Words words) {
    if (words.size() != 1 || (words[0] != "neutral" && words[0] != "none")) return {};
    const auto map = words[0] == "none" ? runtime::ToneMap::none : runtime::ToneMap::neutral;
    return change([map](ViewState& state) { state.tone_map = map; });
}

std::optional<What> parse_terms_word(Words words) {
    if (words.size() != 1) return {};
    const auto terms = formats::parse_terms(words[0], formats::TermSet::baked, "terms");
    if (!terms) return {};
    return change([terms = *terms](ViewState& state) { state.terms = terms; });
}

std::optional<What> parse_toggle(Words words) {
    if (words.size() != 1) return {};
    if (words[0] == "panels") {
        return change([](ViewState& state) { state.panels = !state.panels; });
    }
    const auto term = formats::parse_terms(words[0], formats::TermSet::baked, "toggle");
    if (!term || words[0] == "all") return {};
    return change([term = *term](ViewState& state) { toggle_term(state, term); });
}

// NAME=R,G,B or NAME=V.
std::optional<What> parse_emitter(Words words) {
    if (words.size() != 1) return {};
    const std::size_t equals = words[0].rfind('=');
    if (equals == std::string::npos || equals == 0) return {};
    std::vector<std::string> parts(1);
    for (const char c : words[0].substr(equals + 1)) {
        if (c == ',') {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    const auto values = numbers_in(parts, parts.size(), 0, 1e30);
    if (!values || (parts.size() != 1 && parts.size() != 3)) return {};
    const auto band = [&](std::size_t b) {
        return static_cast<float>((*values)[parts.size() == 1 ? 0 : b]);
    };
    return What{EmitterChange{words[0].substr(0, equals), {band(0), band(1), band(2)}}};
}

std::optional<What> parse_time(Words words) {
    const auto to = numbers_in(words, 1, -1e9, 1e9);
    if (!to) return {};
    return change([v = *to](ViewState& state) { state.time = v[0]; });
}

std::optional<What> parse_coefficients(Words words) {
    if (words.size() == 1 && words[0] == "all") {
        return change([](ViewState& state) { state.coefficients.reset(); });
    }
    const auto to = numbers_in(words, 1, 6, 1 << 20);
    if (!to || (*to)[0] != std::floor((*to)[0])) return {};
    return change(
        [v = *to](ViewState& state) { state.coefficients = static_cast<std::uint32_t>(v[0]); });
}

std::optional<What> parse_load(Words words) {
    if (words.size() != 1) return {};
    return change([path = words[0]](ViewState& state) { show_file(state, path); });
}

std::optional<What> parse_beside(Words words) {
    if (words.size() != 1) return {};
    return change(
        [path = words[0]](ViewState& state) { state.other = path == "none" ? "" : path; });
}

std::optional<What> parse_split(Words words) {
    const auto to = numbers_in(words, 1, 0, 1);
    if (!to) return {};
    return change([v = *to](ViewState& state) { state.split = static_cast<float>(v[0]); });
}

std::optional<What> parse_difference(Words words) {
    const auto to = numbers_in(words, 1, 0, 1e6);
    if (!to) return {};
    return change(
        [v = *to](ViewState& state) { state.difference_gain = static_cast<float>(v[0]); });
}

std::optional<What> parse_receiver_errors(Words words) {
    const auto to = numbers_in(words, 1, 0, 10);
    if (!to || ((*to)[0] > 0 && (*to)[0] < 1e-6)) return {};
    return change([v = *to](ViewState& state) { state.error_white = static_cast<float>(v[0]); });
}

std::optional<What> parse_light(Words words) {
    if (words.size() != 1) return {};
    return change([light = words[0]](ViewState& state) { state.light = light; });
}

std::optional<What> parse_drop(Words words) {
    ViewState trial;
    if (words.size() != 1 || !drop_file(trial, words[0], 0)) return {};
    return change([path = words[0]](ViewState& state) { (void)drop_file(state, path, 0); });
}

std::optional<What> parse_wait_frames(Words words) {
    const auto count = numbers_in(words, 1, 1, 1e6);
    if (!count) return {};
    return What{WaitFrames{static_cast<std::size_t>((*count)[0])}};
}

std::optional<What> parse_wait_reload(Words words) {
    return words.empty() ? std::optional<What>(WaitReload{}) : std::nullopt;
}

bool is_png(Words words) {
    return words.size() == 1 && std::filesystem::path(words[0]).extension() == ".png";
}

std::optional<What> parse_screenshot(Words words) {
    return is_png(words) ? std::optional<What>(Screenshot{words[0], false}) : std::nullopt;
}

std::optional<What> parse_photograph(Words words) {
    return is_png(words) ? std::optional<What>(Screenshot{words[0], true}) : std::nullopt;
}

std::optional<What> parse_quit(Words words) {
    return words.empty() ? std::optional<What>(Quit{}) : std::nullopt;
}

constexpr ScriptCommand kCommands[] = {
    {"orbit", "AZ EL", "move the camera around its target, to the right and up [degrees]",
     parse_orbit},
    {"turn", "X0 Y0 X1 Y1", "arcball: drag the scene; 0 is the middle, 1 half the shorter side",
     parse_turn},
    {"level", "", "make the horizon level again", parse_level},
    {"pan", "X Y", "move the scene, to the right and up [heights of the picture]", parse_pan},
    {"zoom", "F", "go F times nearer to the target", parse_zoom},
    {"frame", "", "frame everything again", parse_frame},
    {"light", "ENV", "another light", parse_light},
    {"rotate-light", "DEG", "turn the light to this angle about +Y", parse_rotate_light},
    {"exposure", "EV|auto", "brighter by a factor of 2^EV; auto: as the picture asks for",
     parse_exposure},
    {"tone-map", "neutral|none", "as `render --tone-map`", parse_tone_map},
    {"terms", "all|LIST", "components to show, as `render --terms`", parse_terms_word},
    {"toggle", "TERM|panels", "show a component, or the controls, or leave them out", parse_toggle},
    {"coefficients", "M|all", "use at most M coefficients of a row", parse_coefficients},
    {"receiver-errors", "E", "errors by receiver in place of light, as `render`; 0: light",
     parse_receiver_errors},
    {"emitter", "NAME=R,G,B", "multiply the light of an emitter", parse_emitter},
    {"time", "S", "move cloud layers by their wind times S [s]", parse_time},
    {"load", "FILE.opal", "another file", parse_load},
    {"beside", "FILE.opal|none", "a second file, right of the split", parse_beside},
    {"split", "X", "share of the width where the second file begins", parse_split},
    {"difference", "GAIN", "there, how far both are apart instead, times GAIN; 0: the second file",
     parse_difference},
    {"drop", "FILE", "drop an .opal, .exr or .hdr file on the window", parse_drop},
    {"wait-frames", "N", "show N frames of the window", parse_wait_frames},
    {"wait-reload", "", "wait until a file changed on disk and was read again", parse_wait_reload},
    {"screenshot", "FILE.png", "write the picture, and print the `render` that makes the same",
     parse_screenshot},
    {"photograph", "FILE.png", "write the whole window, controls included", parse_photograph},
    {"quit", "", "close the window", parse_quit}};

}  // namespace

std::span<const ScriptCommand> script_commands() {
    return kCommands;
}

}  // namespace opaline::cli
