// How far files of `production` are from path tracing, and whether the interval that --check-model
// states holds it. Each cell is a scene in a grey medium: transport mean free path without
// absorption in percent of the diagonal, albedo, mean cosine, index 1.4. Prints what the check
// states and what four times as many other vertices say, without those that the check leaves out.
// `suns`: instead, the error under twelve suns 5 degrees across. Rows of RESULTS.md's tables:
// opaline_error_matrix [suns] SCENE LENGTH,ALBEDO,G...; a minute a cell, suns two.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "bake/accuracy/check_model.h"
#include "bake/accuracy/model_pairs.h"
#include "bake/accuracy/model_receivers.h"
#include "bake/accuracy/model_truth.h"
#include "bake/pipeline/pipeline.h"
#include "bake/reference/reference_image.h"
#include "bake/scene/orient_bodies.h"
#include "formats/gltf/import_gltf.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"
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
    std::printf(" %.1f (%.1f to %.1f); %.1f (%.1f to %.1f), mean %+.1f%s; %.0f s |\n",
                100 * stated.rms_relative, 100 * stated.ci95[0], 100 * stated.ci95[1],
                100 * other.rms_relative, 100 * other.ci95[0], 100 * other.ci95[1],
                100 * other.bias,
                stated.ci95[0] <= other.rms_relative && other.rms_relative <= stated.ci95[1] ? ""
                : holds ? ", intervals overlap"
                        : ", OUTSIDE",
                baked.seconds_total - stated.seconds);
}

// Three at a time, one a band: the medium is grey.
formats::Environment make_suns(int first, int count) {
    formats::Environment sky;
    for (int band = 0; band < 3; ++band) {
        const double place = first + band + 0.5;
        const double height = 1 - 2 * place / count,
                     azimuth = 2 * std::numbers::pi * place / std::numbers::phi;
        const double across = std::sqrt(1 - height * height);
        formats::DistantDisc disc;
        disc.direction = {static_cast<float>(across * std::cos(azimuth)),
                          static_cast<float>(height),
                          static_cast<float>(across * std::sin(azimuth))};
        disc.angular_radius = static_cast<float>(2.5 * std::numbers::pi / 180);
        const auto one = static_cast<float>(1 / formats::disc_solid_angle(disc.angular_radius));
        disc.radiance = {band == 0 ? one : 0, band == 1 ? one : 0, band == 2 ? one : 0};
        sky.discs.push_back(disc);
    }
    return sky;
}

// Paths meet a sun behind the boundary by chance: there are many of them.
void print_suns(const formats::Scene& scene) {
    constexpr int kSuns = 12;
    constexpr double kEvents = 2e8;
    const BakeResult baked = bake(scene, false);
    const formats::AssetView asset = baked.asset.view();
    const OrientedBodies bodies = orient_bodies(scene);  // as --check-model has it
    const ReferenceScene walked =
        make_reference_scene(bodies.scene ? *bodies.scene : scene, 0).value();
    const auto receivers = choose_model_receivers(walked, 192, 2);
    std::vector<ModelPair> pairs;
    for (int first = 0; first < kSuns; first += 3) {
        const formats::Environment sky = make_suns(first, kSuns);
        const LightSampler sampler = make_light_sampler(sky, glm::mat3(1.0f));
        PathOptions paths;
        paths.terms = TermSet::single | TermSet::multiple;
        paths.own_mirror = false;
        EstimateOptions wanted;
        wanted.seed = 2;
        const Estimate pilot =
            estimate_receivers({walked, sampler, paths}, receivers, wanted, {}).value();
        wanted.samples = static_cast<std::uint32_t>(wanted.samples * kEvents /
                                                    static_cast<double>(pilot.events));
        const Estimate truth =
            estimate_receivers({walked, sampler, paths}, receivers, wanted, {}).value();
        const runtime::LightVector light = runtime::project_environment(sky, asset.cubemap_size);
        for (int band = 0; band < 3; ++band) {
            for (std::size_t r = 0; r < receivers.size(); ++r) {
                formats::Rgb shown;
                runtime::shade_range(
                    asset, light,
                    asset.primitives[receivers[r].primitive].first_vertex + receivers[r].vertex,
                    {&shown, 1});
                const double value = static_cast<double>(
                    std::array{shown.r, shown.g, shown.b}[static_cast<std::size_t>(band)]);
                const Moments& m = truth.pixel[r];
                pairs.push_back({value - m.mean[band], m.mean[band], m.variance_of_mean()[band]});
            }
        }
    }
    const MeanSquares all = sum_up(pairs);
    const auto interval = model_interval(pairs, receivers.size(), 0);
    std::printf(" %.1f (%.1f to %.1f), noise of the truth %.1f, mean %+.1f |\n",
                100 * all.rms_relative(), 100 * interval[0], 100 * interval[1], 100 * all.noise(),
                100 * all.bias());
}

int print_matrix(std::span<char*> argument) {
    const bool suns = !argument.empty() && std::strcmp(argument[0], "suns") == 0;
    argument = argument.subspan(suns ? 1 : 0);
    if (argument.size() < 2) {
        std::fprintf(stderr, "usage: opaline_error_matrix [suns] SCENE LENGTH,ALBEDO,G...\n");
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
        (suns ? print_suns : print_cell)(imported->scene);
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
