#include "bake/cli/look_options.h"

#include "bake/cli/option_values.h"
#include "formats/opal/terms.h"

namespace opaline::cli {

void add_rotate_light_option(CLI::App& command, double& degrees) {
    command
        .add_option("--rotate-light", degrees,
                    "turn the light about +Y, from +Z toward +X [degrees]")
        ->check(real_number(-1e6, 1e6))
        ->option_text("DEG [0]");
}

void add_exposure_option(CLI::App& command, std::optional<float>& exposure, const char* otherwise) {
    command
        .add_option("--exposure", exposure,
                    std::string("brighter by a factor of 2^EV; default: ") + otherwise)
        ->check(real_number(-64, 64))
        ->option_text("EV");
}

void add_look_options(CLI::App& command, const LookOptions& options) {
    add_rotate_light_option(command, options.rotate_light);
    command
        .add_option("--terms", options.terms,
                    "components to show: all, or some of " +
                        formats::term_names(formats::TermSet::baked) +
                        "; the background is black, without a cloud layer, unless all are. " +
                        formats::term_names(formats::TermSet::separable, " and ") +
                        " apart need a bake with --separate-terms")
        ->check(term_list())
        ->option_text("all|LIST [all]");
    add_exposure_option(command, options.exposure,
                        "0, but lower where what is shown is too bright for a screen, and higher "
                        "where it is nearly black; 0 of .exr");
    command
        .add_option("--tone-map", options.tone_map,
                    "of screens and .png. neutral: as Khronos PBR Neutral up to its shoulder, "
                    "above it each "
                    "band by itself; none: cut off at 1")
        ->transform(one_of<runtime::ToneMap>(
            {{"neutral", runtime::ToneMap::neutral}, {"none", runtime::ToneMap::none}}))
        ->option_text("neutral|none [neutral]");
    command
        .add_option("--coefficients", options.coefficients,
                    "use at most M coefficients of a row of a mesh, the largest: what a bake with "
                    "fewer looks like")
        ->transform(whole_number(6, 1U << 20U))
        ->option_text("M [all]");
}

}  // namespace opaline::cli
