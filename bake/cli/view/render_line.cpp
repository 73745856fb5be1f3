#include "bake/cli/view/render_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace opaline::cli {
namespace {

constexpr float kDefaultFov = 32;  // of `render`

std::string triple(float x, float y, float z) {
    return fmt::format("{},{},{}", x, y, z);
}

std::string triple(formats::Vec3 v) {
    return triple(v.x, v.y, v.z);
}

}  // namespace

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
