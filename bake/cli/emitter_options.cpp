#include "bake/cli/emitter_options.h"

#include <array>
#include <limits>
#include <string_view>

#include "bake/cli/option_values.h"

namespace opaline::cli {
namespace {

constexpr const char* kOption = "--emitter";

formats::Error refuse_emitter(const std::string& text, std::string fault, std::string remedy) {
    return formats::make_error(formats::ErrorKind::usage, "", std::string(kOption) + " " + text,
                               std::move(fault), std::move(remedy));
}

// "R,G,B" or "V".
std::optional<formats::Rgb> parse_color(std::string_view text) {
    std::array<float, 3> value{};
    std::size_t count = 0;
    for (bool is_last = false; !is_last; ++count) {
        const std::size_t comma = text.find(',');
        is_last = comma == std::string_view::npos;
        const auto number = parse_number(text.substr(0, comma));
        constexpr double kMost = std::numeric_limits<float>::max();
        if (count == value.size() || !number || !(*number >= 0 && *number <= kMost)) return {};
        value[count] = static_cast<float>(*number);
        if (!is_last) text.remove_prefix(comma + 1);
    }
    if (count == 1) return formats::Rgb{value[0], value[0], value[0]};
    if (count == 3) return formats::Rgb{value[0], value[1], value[2]};
    return {};
}

}  // namespace

void add_emitter_option(CLI::App& command, std::vector<std::string>& texts) {
    command
        .add_option(kOption, texts,
                    "multiply the light of an emitter of the file, which `opaline info` lists, by "
                    "R, G and B; 0,0,0 switches it off. May be given for several emitters")
        ->option_text("NAME=R,G,B")
        ->take_all()
        ->allow_extra_args(false);
}

formats::Result<std::vector<formats::Rgb>> parse_emitters(const formats::EmittersView& emitters,
                                                          const std::vector<std::string>& texts) {
    std::vector<formats::Rgb> colors(emitters.size(), {1, 1, 1});
    for (const std::string& text : texts) {
        const std::size_t equals = text.rfind('=');  // names may have one
        if (equals == std::string::npos) {
            return refuse_emitter(text, "expected NAME=R,G,B", "give a name and three factors");
        }
        const std::uint32_t emitter =
            find_emitter(emitters, std::string_view(text).substr(0, equals));
        if (emitter == emitters.size()) {
            return refuse_emitter(text, "the file has no emitter of that name",
                                  emitters.empty() ? "it has none at all: bake a scene with lamps"
                                                   : "it has " + list_emitters(emitters));
        }
        const auto color = parse_color(std::string_view(text).substr(equals + 1));
        if (!color) {
            return refuse_emitter(text, "expected three numbers, finite and not negative",
                                  "give factors such as 1,0.8,0.5, or one for all bands");
        }
        colors[emitter] = *color;
    }
    return colors;
}

}  // namespace opaline::cli
