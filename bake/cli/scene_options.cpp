#include "bake/cli/scene_options.h"

#include <array>
#include <map>
#include <sstream>

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
        const auto knobs = bake::resolve_knobs(options);
        text +=
            std::string(quality == Quality::draft ? " " : ", ") +
            std::string(bake::quality_name(quality)) + " " + std::to_string(knobs->cubemap_size) +
            ", " +
            (knobs->coefficients == bake::kAllCoefficients ? std::string("all")
                                                           : std::to_string(knobs->coefficients));
    }
    return text;
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
    command.add_option("scene", options.scene, "the scene, .gltf or .glb")
        ->required()
        ->option_text("SCENE");
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
    command
        .add_option("--effects", options.effects,
                    "what to simulate: auto, or a list of effects; this version has: direct")
        ->option_text("auto|LIST [auto]");
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

formats::Status check_effects(const SceneOptions& options) {
    constexpr std::array<std::string_view, 11> kKnown{
        "direct",    "multiple",      "single",          "interreflection", "emitters", "specular",
        "filtering", "volume-single", "volume-multiple", "cloud",           "radiosity"};
    if (options.effects == "auto") {
        return formats::ok_status();
    }
    bool direct = false;
    std::stringstream list(options.effects);
    for (std::string name; std::getline(list, name, ',');) {
        const bool known = std::find(kKnown.begin(), kKnown.end(), name) != kKnown.end();
        direct = direct || name == "direct";
        if (name != "direct") {
            return formats::make_error(formats::ErrorKind::usage, "", "--effects",
                                       known ? "this version does not simulate '" + name + "'"
                                             : "there is no effect named '" + name + "'",
                                       "give auto or direct");
        }
    }
    if (!direct) {
        return formats::make_error(formats::ErrorKind::usage, "", "--effects", "the list is empty",
                                   "give auto or direct");
    }
    return formats::ok_status();
}

}  // namespace opaline::cli
