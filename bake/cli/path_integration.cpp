#include <fmt/core.h>

#include <utility>

#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/reference_options.h"
#include "bake/lab/path_images/path_image.h"

namespace opaline::cli {

using formats::ErrorKind;
using formats::make_error;
using formats::TermSet;

void add_path_integration_options(const Command& command, ReferenceOptions& options) {
    command.add(
        "--method",
        one_of(options.method, {{"monte-carlo", ReferenceMethod::monte_carlo},
                                {"path-integration", ReferenceMethod::path_integration}}),
        "monte-carlo: without bias, with noise; path-integration: pictures of volumes without "
        "noise, along most probable paths of light, wrong by 20 to 40 % (RMS over a picture), most "
        "at rims and where light comes from behind the eye: up to a factor of 2. It knows opaque "
        "surfaces, diffuse and without interreflection, and writes no .var.exr");
    options.renormalise_option = command.add(
        "--renormalise", one_of(options.renormalise, {{"on", true}, {"off", false}}),
        "path-integration: scale light scattered twice or more so that a volume without absorption "
        "vanishes under even light; off saves the seconds that this takes before the first pixel");
}

void check_method(const ReferenceOptions& options, TermSet terms) {
    if (!options.by_integration()) {
        if (!options.renormalise_option.is_given()) return;
        refuse_usage("--renormalise", "Monte Carlo needs no renormalisation",
                     "leave it out, or give --method path-integration");
    }
    const std::pair<const char*, bool> of_monte_carlo[] = {
        {"--receivers", options.receivers > 0},
        {"--seconds", options.seconds > 0},
        {"--max-depth", options.max_depth > 0},
        {"--texture-filter", options.texture_filter != TextureFilter::none},
        {"--seed", options.seed > 0}};
    for (const auto& [name, is_given] : of_monte_carlo) {
        if (is_given) {
            refuse_usage(name,
                         "means nothing with --method path-integration, which makes pictures "
                         "without random paths",
                         "leave out one of the two");
        }
    }
    if (!formats::has_any(terms, bake::kPathTerms)) {
        refuse_usage("--terms", "path integration computes none of these",
                     "choose among " + formats::term_names(bake::kPathTerms, ", "));
    }
}

namespace {

// Fidelity "paper" of a scene's volumes: what it contradicts, and a warning.
void check_paper(const ReferenceOptions& options, const formats::Scene& scene) {
    if (!bake::has_paper_fidelity(scene)) return;
    if (options.renormalise && options.renormalise_option.is_given()) {
        refuse(make_error(ErrorKind::usage, scene.volumes.front().name, "--renormalise",
                          "the paper's formulas have no renormalisation, and fidelity is 'paper'",
                          "leave it out, or make the fidelity physical"));
    }
    require(report_warnings({formats::make_warning(
        scene.volumes.front().name, "fidelity",
        "the formulas of [Premoze2003] as printed err more than the corrected ones: light that is "
        "scattered often turns too fast, and even light is not kept",
        "make the fidelity physical, but for the paper's figures")}));
}

}  // namespace

void make_path_picture(const ReferenceOptions& options, const runtime::Camera& camera,
                       const bake::PathSpace& space, const bake::Context& context) {
    const formats::Scene& scene = space.scene.surfaces.scene();
    check_paper(options, scene);
    bake::PathImageOptions wanted;
    wanted.renormalise = options.renormalise;
    wanted.terms = space.options.terms;
    if (options.samples > 0) wanted.rays = options.samples;
    const auto image =
        require(bake::make_path_image(space.scene, space.light, camera, wanted, context));
    const formats::Image& radiance = image.radiance;
    require(write_picture(options.output, {radiance.width, radiance.height, radiance.pixel},
                          options.exposure.value_or(0.0f)));
    print_note(fmt::format(
        "{}: path integration{}, {} rays for each of {} pixels, {}, of which {} before the first "
        "pixel",
        printable(options.output), bake::has_paper_fidelity(scene) ? " with fidelity paper" : "",
        wanted.rays, radiance.pixel.size(), format_seconds(image.seconds),
        format_seconds(image.preparation_seconds)));
}

}  // namespace opaline::cli
