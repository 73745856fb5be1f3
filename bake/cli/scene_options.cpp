#include "bake/cli/scene_options.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include "bake/effects/effects.h"

namespace opaline::cli {
namespace {

using bake::Quality;

// "all" or a number; CLI11 hands over the text.
std::string parse_coefficients(std::string& text) {
    if (text == "all") {
        text = std::to_string(bake::kAllCoefficients);
    }
    return {};
}

std::string quality_help() {
    std::string text = "cube map size, coefficients:";
    for (const Quality quality :
         {Quality::draft, Quality::preview, Quality::production, Quality::reference}) {
        bake::BakeOptions options;
        options.quality = quality;
        const auto knobs = bake::resolve_knobs(bake::all_effects(), options);
        text +=
            std::string(quality == Quality::draft ? " " : ", ") +
            std::string(bake::quality_name(quality)) + " " + std::to_string(knobs->cubemap_size) +
            ", " +
            (knobs->coefficients == bake::kAllCoefficients ? std::string("all")
                                                           : std::to_string(knobs->coefficients));
    }
    return text;
}

std::string list_effects(const char* separator) {
    std::string names;
    for (const bake::EffectDescriptor& effect : bake::all_effects().effects) {
        if (!effect.help.empty()) {
            names += (names.empty() ? "" : separator) + std::string(effect.name);
        }
    }
    return names;
}

// The option of an effect's knob.
void add_knob_option(CLI::App& command, const bake::KnobSpec& knob, bake::BakeOptions& options) {
    const auto take = [&knob, &options](const double& value) { options.set(knob, value); };
    CLI::Option* const option =
        command.add_option_function<double>(std::string(knob.option), take, std::string(knob.help));
    option->option_text(std::string(knob.placeholder));
    option->check(CLI::Range(knob.lowest, knob.highest));
    if (knob.whole) {
        option->check(CLI::Validator(
            [](const std::string& text) {
                const bool is_whole = text.find_first_not_of("0123456789") == std::string::npos;
                return is_whole ? std::string() : text + " is not a whole number";
            },
            ""));
    }
}

}  // namespace

void add_subject_options(CLI::App& command, SceneOptions& options) {
    command.add_option("scene", options.scene, "the scene, .gltf or .glb")
        ->required()
        ->option_text("SCENE");
    command
        .add_option(
            "--media", options.media,
            "what translucent materials are made of; formats/media/README.md lists the keys")
        ->option_text("FILE.json");
    command
        .add_option(
            "--effects", options.effects,
            std::string("what to simulate: auto, what the scene calls for; all, everything that concerns "
            "it, however little it adds, and without shortcuts; or a list of effects, of ") +
            "which this version has: " +
                list_effects(", "))
        ->option_text("auto|all|LIST [auto]");
    command
        .add_option("--seed", options.bake.seed,
                    "of everything random: which receivers the error is measured at")
        ->check(CLI::NonNegativeNumber)
        ->option_text("S [0]");
    command
        .add_option("--threads", options.bake.threads,
                    "0: one per core; the result is the same for any number")
        ->check(CLI::Range(0u, 1024u))
        ->option_text("T [0]");
    command
        .add_option("--metres-per-unit", options.metres_per_unit,
                    "length of one unit of the scene file")
        ->option_text("X [1]");
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
    add_subject_options(command, options);
    command.add_option("--quality", options.bake.quality, quality_help())
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, Quality>{{"draft", Quality::draft},
                                           {"preview", Quality::preview},
                                           {"production", Quality::production},
                                           {"reference", Quality::reference}}))
        ->option_text("draft|preview|production|reference [preview]");
    command
        .add_option("--cubemap", options.bake.cubemap_size,
                    "texels along a face of the light's cube map: 8, 16, 32, 64 or 128; default as "
                    "the quality says")
        ->option_text("N");
    command
        .add_option("--coefficients", options.bake.coefficients,
                    "wavelet coefficients kept per receiver, 7 or more, or `all`; default as the "
                    "quality says")
        ->transform(CLI::Validator(parse_coefficients, ""))
        ->option_text("M");
    for (const bake::EffectDescriptor& effect : bake::all_effects().effects) {
        for (const bake::KnobSpec* knob : effect.knobs) {
            if (!knob->option.empty()) {
                add_knob_option(command, *knob, options.bake);
            }
        }
    }
    command.add_flag("--separate-terms", options.bake.separate_terms,
                     "keep multiple scattering apart from single, so that `render --terms` can "
                     "show each");
}

void add_error_option(CLI::App& command, SceneOptions& options) {
    command
        .add_option("--error", options.bake.error,
                    "relative RMS error that the file may have: a pilot measures what each knob "
                    "costs and picks the cheapest; those given stay")
        ->check(CLI::Range(1e-4, 0.99))
        ->excludes("--quality")
        ->option_text("E");
}

formats::Result<bake::BakeOptions> parse_effects(const SceneOptions& options) {
    // Of later versions; whoever names one should not take it for a slip of the pen.
    constexpr std::array<std::string_view, 7> kLater{
        "interreflection", "emitters", "filtering", "volume-single", "volume-multiple",
        "cloud",           "radiosity"};
    bake::BakeOptions wanted = options.bake;
    if (options.effects == "auto") {
        return wanted;
    }
    if (options.effects == "all") {
        wanted.simulate_all = true;
        return wanted;
    }
    const auto refuse = [](std::string fault) {
        return formats::make_error(formats::ErrorKind::usage, "", "--effects", std::move(fault),
                                   "give auto, all, or some of " + list_effects(","));
    };
    std::stringstream list(options.effects);
    for (std::string name; std::getline(list, name, ',');) {
        const auto& here = bake::all_effects().effects;
        const bool is_here = std::any_of(here.begin(), here.end(), [&](const auto& effect) {
            return effect.name == name && !effect.help.empty();
        });
        if (!is_here) {
            const bool is_later = std::find(kLater.begin(), kLater.end(), name) != kLater.end();
            return refuse(name == "all" || name == "auto"
                              ? "'" + name + "' stands by itself, not in a list"
                          : is_later ? "this version does not simulate '" + name + "'"
                                     : "there is no effect named '" + name + "'");
        }
        wanted.effects.push_back(name);
    }
    if (wanted.effects.empty()) {
        return refuse("the list is empty");
    }
    return wanted;
}

}  // namespace opaline::cli
