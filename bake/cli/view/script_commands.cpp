#include "bake/cli/view/script_commands.h"

#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "bake/cli/view/view_script.h"
#include "bake/cli/view/view_state.h"
#include "formats/opal/terms.h"

namespace opaline::cli {
namespace {

using Words = std::span<const std::string>;
using What = decltype(ScriptStep::what);

constexpr double kMostDegrees = 1e6;

using Parse = decltype(ScriptCommand::parse);

// A command of `count` numbers, which `apply` gets.
Parse numbers(std::size_t count, double least, double most,
              void (*apply)(ViewState& state, const std::vector<double>& v)) {
    return [=](Words words) -> std::optional<What> {
        const auto values = numbers_in(words, count, least, most);
        if (!values) return {};
        return StateChange([apply, v = *values](ViewState& state) { apply(state, v); });
    };
}

// Of one word.
Parse word(void (*apply)(ViewState& state, const std::string& word)) {
    return [=](Words words) -> std::optional<What> {
        if (words.size() != 1) return {};
        return StateChange([apply, text = words[0]](ViewState& state) { apply(state, text); });
    };
}

// Of nothing else.
Parse alone(const What& what) {
    return [=](Words words) { return words.empty() ? std::optional(what) : std::nullopt; };
}

// The word `special`, or as `otherwise` has it.
Parse either(const char* special, void (*apply)(ViewState& state), const Parse& otherwise) {
    return [=](Words words) -> std::optional<What> {
        if (words.size() == 1 && words[0] == special) return StateChange(apply);
        return otherwise(words);
    };
}

// Of words for which `apply` finds a change of a state.
Parse where_possible(bool (*apply)(ViewState& state, const std::string& word)) {
    return [=](Words words) -> std::optional<What> {
        ViewState trial;
        if (words.size() != 1 || !apply(trial, words[0])) return {};
        return StateChange([apply, text = words[0]](ViewState& state) { apply(state, text); });
    };
}

Parse png(bool with_panels) {
    return [=](Words words) -> std::optional<What> {
        if (words.size() != 1 || std::filesystem::path(words[0]).extension() != ".png") return {};
        return Screenshot{words[0], with_panels};
    };
}

bool set_terms(ViewState& state, const std::string& names) {
    const auto terms = formats::parse_terms(names, formats::TermSet::baked, "terms");
    if (terms) state.terms = *terms;
    return terms.has_value();
}

bool toggle(ViewState& state, const std::string& name) {
    const auto term = formats::parse_terms(name, formats::TermSet::baked, "toggle");
    if (!term || name == "all") return false;
    toggle_term(state, *term);
    return true;
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

std::optional<What> parse_coefficients(Words words) {
    const auto to = numbers_in(words, 1, 6, 1 << 20);
    if (!to || (*to)[0] != std::floor((*to)[0])) return {};
    return StateChange(
        [v = *to](ViewState& state) { state.coefficients = static_cast<std::uint32_t>(v[0]); });
}

std::optional<What> parse_receiver_errors(Words words) {
    const auto to = numbers_in(words, 1, 0, 10);
    if (!to || ((*to)[0] > 0 && (*to)[0] < 1e-6)) return {};
    return StateChange(
        [v = *to](ViewState& state) { state.error_white = static_cast<float>(v[0]); });
}

std::optional<What> parse_wait_frames(Words words) {
    const auto count = numbers_in(words, 1, 1, 1e6);
    if (!count) return {};
    return WaitFrames{static_cast<std::size_t>((*count)[0])};
}

using State = ViewState;
using Values = std::vector<double>;

const ScriptCommand kCommands[] = {
    {"orbit", "AZ EL", "move the camera around its target, to the right and up [degrees]",
     numbers(
         2, -kMostDegrees, kMostDegrees,
         [](State& s, const Values& v) { s.viewpoint = orbit_level(*s.viewpoint, v[0], v[1]); })},
    {"turn", "X0 Y0 X1 Y1", "arcball: drag the scene; 0 is the middle, 1 half the shorter side",
     numbers(4, -10, 10,
             [](State& s, const Values& v) {
                 s.viewpoint = turn_ball(*s.viewpoint, {v[0], v[1]}, {v[2], v[3]});
             })},
    {"level", "", "make the horizon level again",
     alone(StateChange([](State& s) { s.viewpoint = level(*s.viewpoint); }))},
    {"pan", "X Y", "move the scene, to the right and up [heights of the picture]",
     numbers(
         2, -1e3, 1e3,
         [](State& s, const Values& v) { s.viewpoint = pan(*s.viewpoint, s.fov, v[0], v[1]); })},
    {"zoom", "F", "go F times nearer to the target",
     numbers(1, 1e-6, 1e6,
             [](State& s, const Values& v) { s.viewpoint = zoom(*s.viewpoint, 1 / v[0]); })},
    {"frame", "", "frame everything again",
     alone(StateChange([](State& s) { s.viewpoint.reset(); }))},
    {"light", "ENV", "another light", word([](State& s, const std::string& w) { s.light = w; })},
    {"rotate-light", "DEG", "turn the light to this angle about +Y",
     numbers(1, -kMostDegrees, kMostDegrees,
             [](State& s, const Values& v) { rotate_light_to(s, v[0]); })},
    {"exposure", "EV|auto", "brighter by a factor of 2^EV; auto: as the picture asks for",
     either(
         "auto", [](State& s) { s.exposure.reset(); },
         numbers(1, -64, 64,
                 [](State& s, const Values& v) { s.exposure = static_cast<float>(v[0]); }))},
    {"tone-map", "neutral|none", "as `render --tone-map`",
     either(
         "neutral", [](State& s) { s.tone_map = runtime::ToneMap::neutral; },
         either(
             "none", [](State& s) { s.tone_map = runtime::ToneMap::none; },
             [](Words) { return std::optional<What>(); }))},
    {"terms", "all|LIST", "components to show, as `render --terms`", where_possible(set_terms)},
    {"toggle", "TERM|panels", "show a component, or the controls, or leave them out",
     either(
         "panels", [](State& s) { s.panels = !s.panels; }, where_possible(toggle))},
    {"coefficients", "M|all", "use at most M coefficients of a row",
     either(
         "all", [](State& s) { s.coefficients.reset(); }, parse_coefficients)},
    {"receiver-errors", "E", "errors by receiver in place of light, as `render`; 0: light",
     parse_receiver_errors},
    {"emitter", "NAME=R,G,B", "multiply the light of an emitter", parse_emitter},
    {"time", "S", "move cloud layers by their wind times S [s]",
     numbers(1, -1e9, 1e9, [](State& s, const Values& v) { s.time = v[0]; })},
    {"load", "FILE.opal", "another file", word(show_file)},
    {"beside", "FILE.opal|none", "a second file, right of the split",
     word([](State& s, const std::string& w) { s.other = w == "none" ? "" : w; })},
    {"split", "X", "share of the width where the second file begins",
     numbers(1, 0, 1, [](State& s, const Values& v) { s.split = static_cast<float>(v[0]); })},
    {"difference", "GAIN", "there, how far both are apart instead, times GAIN; 0: the second file",
     numbers(1, 0, 1e6,
             [](State& s, const Values& v) { s.difference_gain = static_cast<float>(v[0]); })},
    {"drop", "FILE", "drop an .opal, .exr or .hdr file on the window",
     where_possible([](State& s, const std::string& w) { return drop_file(s, w, 0).has_value(); })},
    {"wait-frames", "N", "show N frames of the window", parse_wait_frames},
    {"wait-reload", "", "wait until a file changed on disk and was read again",
     alone(WaitReload{})},
    {"screenshot", "FILE.png", "write the picture, and print the `render` that makes the same",
     png(false)},
    {"photograph", "FILE.png", "write the whole window, controls included", png(true)},
    {"quit", "", "close the window", alone(Quit{})}};

}  // namespace

std::span<const ScriptCommand> script_commands() {
    return kCommands;
}

}  // namespace opaline::cli
