// How far files of `production` are from path tracing, and whether the interval that --check-model
// states holds it. Each cell is a scene in a grey medium: transport mean free path without
// absorption in percent of the diagonal, albedo, mean cosine, index 1.4. Prints what the check
// states and what four times as many other vertices say, without those that the check leaves out;
// then what it states of suns. Rows of RESULTS.md's tables:
// opaline_bench error-matrix SCENE LENGTH,ALBEDO,G...; a minute a cell.
#include <cstdio>
#include <vector>

#include "bake/check/check_model.h"
#include "bake/check/model_pairs.h"
#include "bake/pipeline/pipeline.h"
#include "runtime/light_vector.h"
#include "tests/bench/bench.h"
#include "tests/bench/grey_cells.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

ModelErrorReport at_other_vertices(const formats::Scene& scene, const formats::AssetView& asset) {
    ModelCheckOptions options;
    options.simulated = TermSet::single | TermSet::multiple;
    options.seed = 1;
    options.receivers *= 4;
    options.max_events *= 4;
    const ModelProbes probes =
        choose_model_probes(scene, options.receivers, options.seed, {}).value();
    const auto truth = trace_model_truth(scene, probes, options, {}).value();
    std::vector<std::vector<double>> luminance;
    for (const ModelLight& light : probes.lights) {
        const runtime::LightVector vector =
            runtime::project_environment(light.environment, asset.cubemap_size);
        luminance.push_back(relight_receivers(asset, probes.receivers, {.vector = vector}));
    }
    return compare_with_truth(luminance, truth, probes, options.seed);
}

void print_other_vertices(const ModelErrorReport& stated, const ModelErrorReport& other) {
    const bool holds = stated.ci95[0] <= other.ci95[1] && other.ci95[0] <= stated.ci95[1];
    std::printf(" %.1f (%.1f to %.1f), mean %+.1f%s;", 100 * other.rms_relative,
                100 * other.ci95[0], 100 * other.ci95[1], 100 * other.bias,
                stated.ci95[0] <= other.rms_relative && other.rms_relative <= stated.ci95[1] ? ""
                : holds ? ", intervals overlap"
                        : ", OUTSIDE");
}

void print_cell(const formats::Scene& scene) {
    BakeOptions options;
    options.effects = {"multiple", "single"};
    options.quality = Quality::production;
    options.check_model = true;
    const BakeResult baked = run_bake(scene, resolve_knobs(options).value(), {}).value();
    const ModelErrorReport& stated = *baked.model_error;
    std::printf(" %.1f (%.1f to %.1f), mean %+.1f;", 100 * stated.rms_relative,
                100 * stated.ci95[0], 100 * stated.ci95[1], 100 * stated.bias);
    print_other_vertices(stated, at_other_vertices(scene, baked.asset.view()));
    const ModelErrorReport::Suns& suns = *stated.suns;
    std::printf(" suns %.1f (%.1f to %.1f), mean %+.1f, noise %.0f; %.0f s, check %.0f s |\n",
                100 * suns.rms_relative, 100 * suns.ci95[0], 100 * suns.ci95[1], 100 * suns.bias,
                100 * suns.noise, baked.seconds_total - stated.seconds, stated.seconds);
}

}  // namespace
}  // namespace opaline::bake

int opaline::tests::error_matrix(int count, char** argument) {
    return opaline::bake::print_grey_cells(count, argument, opaline::bake::print_cell);
}
