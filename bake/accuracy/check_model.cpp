#include "bake/accuracy/check_model.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <utility>

#include "bake/accuracy/check_suns.h"
#include "bake/accuracy/model_lights.h"
#include "bake/accuracy/model_pairs.h"
#include "bake/accuracy/model_receivers.h"
#include "bake/accuracy/model_scenes.h"
#include "runtime/light_vector.h"
#include "runtime/specular.h"

namespace opaline::bake {
namespace {

// Those of opaque surfaces that mirror. A medium's boundary is perfectly smooth in the reference.
std::vector<ReferenceReceiver> find_mirrors(const formats::AssetView& asset,
                                            std::span<const ReferenceReceiver> receivers) {
    std::vector<ReferenceReceiver> mirrors;
    for (const ReferenceReceiver& r : receivers) {
        if (!asset.gloss.empty() && asset.gloss[r.primitive].is_glossy()) {
            mirrors.push_back(r);
        }
    }
    return mirrors;
}

formats::Result<ModelErrorReport::Mirrored> check_mirrors(
    const ReferenceScene& scene, const formats::AssetView& asset,
    std::span<const ReferenceReceiver> mirrors, std::span<const ModelLight> lights,
    const ModelCheckOptions& options, const Context& context) {
    PathOptions paths;
    paths.terms = TermSet::specular;
    std::vector<ModelPair> pairs;  // light by light
    for (const ModelLight& light : lights) {
        const LightSampler sampler = make_light_sampler(light.environment, glm::mat3(1.0f));
        const runtime::LightVector vector = runtime::project_environment(
            light.environment, asset.cubemap_size, {}, context.threads);
        const runtime::SpecularLight lobes = runtime::make_specular_light(
            light.environment, runtime::specular_needs(asset), {}, context.threads);
        const auto check =
            check_light(std::array{PathSpace{scene, sampler, paths}}, mirrors,
                        relight_receivers(asset, mirrors, {vector, &lobes}), options, context);
        if (!check) {
            return check.error();
        }
        pairs.insert(pairs.end(), check->pairs.begin(), check->pairs.end());
    }
    ModelErrorReport::Mirrored report;
    const MeanSquares all = sum_up(pairs);
    report.rms_relative = all.rms_relative();
    report.bias = all.bias();
    report.receivers_checked = static_cast<std::uint32_t>(mirrors.size());
    std::ranges::copy(model_interval(pairs, mirrors.size(), options.seed), report.ci95);
    return report;
}

}  // namespace

TermSet held_light(const EffectTable& effects, std::span<const PlanEntry> plan) {
    TermSet held = ModelCheckOptions().simulated;
    for (const PlanEntry& entry : plan) {
        held |= entry.on && entry.rule == 0 ? effects[entry.effect].held_light : TermSet::none;
    }
    return held;
}

formats::Result<ModelErrorReport> check_model(const formats::Scene& given,
                                              const formats::AssetView& asset,
                                              const ModelCheckOptions& options,
                                              const Context& context) {
    const auto start = std::chrono::steady_clock::now();
    const auto scenes = make_model_scenes(given, context.threads);
    if (!scenes) {
        return scenes.error();
    }
    std::vector<std::string> left_out;
    const auto lights = make_model_lights(given, left_out);
    if (!lights) {
        return lights.error();
    }
    const std::vector<ReferenceReceiver> receivers =
        choose_model_receivers(scenes->whole, options.receivers, options.seed);
    std::vector<LightCheck> checks;
    for (const ModelLight& light : *lights) {
        const runtime::LightVector vector = runtime::project_environment(
            light.environment, asset.cubemap_size, {}, context.threads);
        auto check = check_unmirrored(*scenes, light, receivers,
                                      relight_receivers(asset, receivers, {.vector = vector}),
                                      options, context);
        if (!check) {
            return std::move(check).error();
        }
        checks.push_back(std::move(*check));
    }
    ModelErrorReport report = make_model_report(checks, receivers.size(), options.seed);
    report.left_out = std::move(left_out);
    if (const auto mirrors = find_mirrors(asset, receivers); !mirrors.empty()) {
        auto mirrored = check_mirrors(scenes->whole, asset, mirrors, *lights, options, context);
        if (!mirrored) {
            return std::move(mirrored).error();
        }
        report.mirrored = *mirrored;
    }
    auto suns = check_suns(*scenes, asset, receivers, options, context);
    if (!suns) {
        return std::move(suns).error();
    }
    report.suns = *suns;
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

}  // namespace opaline::bake
