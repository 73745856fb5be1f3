#include "bake/cli/view/view_script.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include "bake/cli/view/script_commands.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;

using What = decltype(ScriptStep::what);

std::string usage_of(const ScriptCommand& command) {
    return std::string(command.name) + (command.arguments[0] != '\0' ? " " : "") +
           command.arguments;
}

formats::Result<What> parse_line(const std::vector<std::string>& words) {
    for (const ScriptCommand& command : script_commands()) {
        if (words[0] != command.name) continue;
        auto what = command.parse(std::span(words).subspan(1));
        if (what) return std::move(*what);
        return make_error(ErrorKind::bad_input, "", "", "expected " + usage_of(command),
                          command.help);
    }
    std::string names;
    for (const ScriptCommand& command : script_commands()) {
        names += (names.empty() ? "" : ", ") + std::string(command.name);
    }
    return make_error(ErrorKind::bad_input, "", "", "'" + words[0] + "' is no command",
                      "commands are " + names);
}

bool shows_the_same_files(const ViewState& a, const ViewState& b) {
    return a.file == b.file && a.other == b.other && a.light == b.light;
}

bool has_name(std::span<const std::string> names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

formats::Error refuse_emitter(const std::string& name, const ScriptRun::Shown& shown) {
    std::string known;
    for (const auto& names : {shown.emitters, shown.other_emitters}) {
        for (const std::string& one : names)
            known += (known.empty() ? "" : ", ") + one;
    }
    return formats::make_error(
        formats::ErrorKind::bad_input, "", "", "no emitter has the name '" + name + "'",
        known.empty() ? "there is none at all: bake a scene with lamps" : "there are " + known);
}

constexpr float kDefaultFov = 32;  // of `render`

std::string triple(float x, float y, float z) {
    return fmt::format("{},{},{}", x, y, z);
}

std::string triple(formats::Vec3 v) {
    return triple(v.x, v.y, v.z);
}

}  // namespace

formats::Result<std::vector<ScriptStep>> parse_script(std::string_view text,
                                                      const std::string& file) {
    std::vector<ScriptStep> steps;
    formats::Error faults{ErrorKind::bad_input, {}};
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const auto words = words_of(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (words && words->empty()) continue;
        auto what = words ? parse_line(*words)
                          : make_error(ErrorKind::bad_input, "", "", "a quote is not closed",
                                       "close it on its line");
        if (what) {
            ScriptStep& step = steps.emplace_back();
            step.line = number;
            step.what = std::move(*what);
            continue;
        }
        formats::Diagnostic fault = what.error().diagnostics.front();
        fault.file = file;
        fault.where = "line " + std::to_string(number);
        faults.diagnostics.push_back(std::move(fault));
    }
    if (!faults.diagnostics.empty()) return faults;
    return steps;
}

std::string script_help() {
    constexpr std::size_t kColumn = 28;
    std::string help;
    for (const ScriptCommand& command : script_commands()) {
        std::string usage = "  " + usage_of(command);
        usage.resize(std::max(usage.size() + 1, kColumn), ' ');
        help += usage + command.help + "\n";
    }
    return help;
}

std::optional<std::vector<std::string>> words_of(std::string_view line) {
    std::vector<std::string> words;
    bool in_word = false, in_quotes = false;
    for (const char c : line) {
        if (in_quotes) {
            if (c == '"') {
                in_quotes = false;
            } else {
                words.back() += c;
            }
            continue;
        }
        if (c == '#') break;
        if (c == ' ' || c == '\t' || c == '\r') {
            in_word = false;
            continue;
        }
        if (!in_word) words.emplace_back();
        in_word = true;
        if (c == '"') {
            in_quotes = true;
        } else {
            words.back() += c;
        }
    }
    if (in_quotes) return {};
    return words;
}

std::optional<double> number_in(const std::string& text, double least, double most) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || next != end || !(value >= least && value <= most)) return {};
    return value;
}

std::optional<std::vector<double>> numbers_in(std::span<const std::string> words, std::size_t count,
                                              double least, double most) {
    std::vector<double> values;
    if (words.size() != count) return {};
    for (const std::string& word : words) {
        const auto value = number_in(word, least, most);
        if (!value) return {};
        values.push_back(*value);
    }
    return values;
}

// Whether the step is done.
bool ScriptRun::carry_out(const ScriptStep& step, ViewState& state, const Shown& shown) {
    if (const auto* change = std::get_if<StateChange>(&step.what)) {
        if (!state.viewpoint) return false;
        const ViewState before = state;
        (*change)(state);
        opens_ = !shows_the_same_files(before, state);
        return true;
    }
    if (const auto* change = std::get_if<EmitterChange>(&step.what)) {
        if (!shown.is_settled) return false;  // the names are those of the files before
        if (!has_name(shown.emitters, change->name) &&
            !has_name(shown.other_emitters, change->name)) {
            error_ = refuse_emitter(change->name, shown);
            return false;
        }
        set_emitter(state, change->name, change->color);
        return true;
    }
    if (const auto* wait = std::get_if<WaitFrames>(&step.what)) return waited_++ >= wait->frames;
    if (std::holds_alternative<WaitReload>(step.what)) return shown.is_reloaded && shown.is_settled;
    if (const auto* screenshot = std::get_if<Screenshot>(&step.what)) {
        // Controls take a few frames to find their sizes.
        constexpr std::size_t kFrames = 4;
        if (!shown.is_settled || shown.settled_frames < kFrames) return false;
        shot_ = *screenshot;
        return true;
    }
    quits_ = true;
    return true;
}

void ScriptRun::advance(ViewState& state, Shown shown) {
    if (next_ == steps_.size() && (shown.is_settled || quits_)) {
        is_done_ = true;
        line_ = 0;
    }
    while (next_ < steps_.size() && !shot_ && !quits_) {
        if (opens_ && !shown.is_settled) return;
        opens_ = false;
        const ScriptStep& step = steps_[next_];
        line_ = step.line;
        if (!carry_out(step, state, shown)) return;
        // What a change asks for is not drawn yet.
        if (std::holds_alternative<StateChange>(step.what) ||
            std::holds_alternative<EmitterChange>(step.what)) {
            shown.is_settled = false;
        }
        ++next_;
        waited_ = 0;
    }
}

formats::Status drop_file(ViewState& state, const std::string& path, double share) {
    const std::string ending = std::filesystem::path(path).extension().string();
    if (ending == ".exr" || ending == ".hdr") {
        state.light = path;
        return formats::ok_status();
    }
    if (ending != ".opal") {
        return formats::make_error(formats::ErrorKind::usage, path, "",
                                   "is no .opal, .exr or .hdr file",
                                   "drop a baked asset or a light");
    }
    if (!state.other.empty() && share > static_cast<double>(state.split)) {
        state.other = path;
    } else {
        show_file(state, path);
    }
    return formats::ok_status();
}

std::string quote_word(const std::string& word) {
    const bool is_plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string("_./:,=+-@%").find(static_cast<char>(c)) != std::string::npos;
    });
    if (is_plain) return word;
    std::string quoted = "'";
    for (const char c : word) {
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return quoted + "'";
}

std::string render_line(const ViewState& state, const std::string& file, const Viewpoint& from,
                        const std::string& output) {
    std::string line = fmt::format("opaline render {} --light {} --size {}x{} --eye {} --target {}",
                                   quote_word(file), quote_word(state.light), state.width,
                                   state.height, triple(from.eye), triple(from.target));
    if (from.up != formats::Vec3{0, 1, 0}) line += " --up " + triple(from.up);
    if (state.fov != kDefaultFov) line += fmt::format(" --fov {}", state.fov);
    if (state.error_white > 0) {  // nothing below changes that picture
        return line +
               fmt::format(" --receiver-errors {} -o {}", state.error_white, quote_word(output));
    }
    if (state.rotate_light != 0) line += fmt::format(" --rotate-light {}", state.rotate_light);
    if (state.time != 0) line += fmt::format(" --time {}", state.time);
    if (state.terms != formats::TermSet::baked) {
        line += " --terms " + formats::term_names(state.terms);
    }
    if (state.coefficients) line += fmt::format(" --coefficients {}", *state.coefficients);
    for (const EmitterColor& emitter : state.emitters) {
        const formats::Rgb c = emitter.color;
        line += " --emitter " + quote_word(emitter.name + "=" + triple(c.r, c.g, c.b));
    }
    if (state.exposure) line += fmt::format(" --exposure {}", *state.exposure);
    if (state.tone_map == runtime::ToneMap::none) line += " --tone-map none";
    return line + " -o " + quote_word(output);
}

}  // namespace opaline::cli
