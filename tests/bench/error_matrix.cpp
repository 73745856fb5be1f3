// How far files of `production` are from path tracing, and whether the interval that --check-model
// states holds it. Each cell is a scene in a grey medium: transport mean free path without
// absorption in percent of the diagonal, albedo, mean cosine, index 1.4. Prints what the check
// states and what four times as many other vertices say, without those that the check leaves out;
// then what it states of suns. Rows of RESULTS.md's tables:
// opaline_error_matrix SCENE LENGTH,ALBEDO,G...; a minute a cell.
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "bake/accuracy/check_model.h"
#include "bake/accuracy/model_pairs.h"
#include "bake/accuracy/model_truth.h"
#include "bake/pipeline/pipeline.h"
#include "formats/gltf/import_gltf.h"
#include "runtime/light_vector.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

struct Cell {
    float length = 0, albedo = 0, cosine = 0;  // length in percent of the diagonal
};

void fill(formats::Scene& scene, const Cell& cell) {
    glm::vec3 low(HUGE_VALF), high(-HUGE_VALF);
    for (const formats::Primitive& p : scene.primitives) {
        for (const glm::vec3& x : p.position) {
            low = glm::min(low, x);
            high = glm::max(high, x);
        }
    }
    const float reduced = 100 / (cell.length * glm::length(high - low));
    formats::Medium medium;
    const float sigma_s = reduced / (1 - cell.cosine);
    const float sigma_a = sigma_s * (1 - cell.albedo) / cell.albedo;
    medium.sigma_s = {sigma_s, sigma_s, sigma_s};
    medium.sigma_a = {sigma_a, sigma_a, sigma_a};
    medium.eta = 1.4f;
    if (cell.cosine != 0) {
        medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
        medium.phase.g = cell.cosine;
    }
    for (auto& material : scene.materials) {
        material.medium = medium;
    }
}

BakeResult bake(const formats::Scene& scene, bool check) {
    BakeOptions options;
    options.effects = {"multiple", "single"};
    options.quality = Quality::production;
    options.check_model = check;
    return run_bake(scene, resolve_knobs(options).value(), {}).value();
}

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

void print_cell(const formats::Scene& scene) {
    const BakeResult baked = bake(scene, true);
    const ModelErrorReport& stated = *baked.model_error;
    const ModelErrorReport other = at_other_vertices(scene, baked.asset.view());
    const bool holds = stated.ci95[0] <= other.ci95[1] && other.ci95[0] <= stated.ci95[1];
    const ModelErrorReport::Suns& suns = *stated.suns;
    std::printf(
        " %.1f (%.1f to %.1f); %.1f (%.1f to %.1f), mean %+.1f%s; suns %.1f (%.1f to %.1f), mean "
        "%+.1f, noise %.0f; %.0f s, check %.0f s |\n",
        100 * stated.rms_relative, 100 * stated.ci95[0], 100 * stated.ci95[1],
        100 * other.rms_relative, 100 * other.ci95[0], 100 * other.ci95[1], 100 * other.bias,
        stated.ci95[0] <= other.rms_relative && other.rms_relative <= stated.ci95[1] ? ""
        : holds ? ", intervals overlap"
                : ", OUTSIDE",
        100 * suns.rms_relative, 100 * suns.ci95[0], 100 * suns.ci95[1], 100 * suns.bias,
        100 * suns.noise, baked.seconds_total - stated.seconds, stated.seconds);
}

int print_matrix(std::span<char*> argument) {
    if (argument.size() < 2) {
        std::fprintf(stderr, "usage: opaline_error_matrix SCENE LENGTH,ALBEDO,G...\n");
        return 2;
    }
    const std::string file = argument[0];
    auto imported = formats::import_gltf(file);
    if (!imported) {
        std::fprintf(stderr, "cannot read %s\n", file.c_str());
        return 1;
    }
    for (const char* text : argument.subspan(1)) {
        Cell cell;
        if (std::sscanf(text, "%f,%f,%f", &cell.length, &cell.albedo, &cell.cosine) != 3) {
            std::fprintf(stderr, "not LENGTH,ALBEDO,G: %s\n", text);
            return 2;
        }
        fill(imported->scene, cell);
        std::printf("| %s | %s |", file.c_str(), text);
        print_cell(imported->scene);
        std::fflush(stdout);
    }
    return 0;
}

}  // namespace
}  // namespace opaline::bake

int main(int count, char** argument) {
    return opaline::bake::print_matrix(
        std::span(argument, static_cast<std::size_t>(count)).subspan(1));
}
