#include "bake/accuracy/check_model.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include "bake/accuracy/model_pairs.h"
#include "bake/accuracy/model_receivers.h"
#include "bake/environment/builtin_environment.h"
#include "bake/reference/reference_image.h"
#include "bake/scene/orient_bodies.h"
#include "bake/truth/test_lights.h"
#include "formats/opal/rgb.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"
#include "runtime/specular.h"

namespace opaline::bake {
namespace {

struct ModelLight {
    std::string name;
    formats::Environment environment;
};

bool refracts(const formats::Scene& scene) {
    return std::any_of(scene.primitives.begin(), scene.primitives.end(), [&](const auto& p) {
        const auto& medium = scene.materials[p.material].medium;
        return medium && !p.index.empty() && !is_matched(medium->eta);
    });
}

// The published lights under which the reference converges.
formats::Result<std::vector<ModelLight>> make_model_lights(bool with_suns,
                                                           std::vector<std::string>& left_out) {
    std::vector<ModelLight> lights;
    for (const char* name : published_lights()) {
        auto environment = make_environment(name);
        if (!environment) {
            return std::move(environment).error();
        }
        ModelLight light{name, std::move(*environment)};
        if (!with_suns && !light.environment.discs.empty()) {
            left_out.emplace_back(name);
            if (light.environment.pixel.empty()) {
                continue;
            }
            light.environment.discs.clear();
            light.name += " without its sun";
        }
        lights.push_back(std::move(light));
    }
    return lights;
}

// The file's luminance along the normals; `mirrored`: of mirrored light alone, else without any.
std::vector<double> relight_receivers(const formats::AssetView& asset,
                                      std::span<const ReferenceReceiver> receivers,
                                      const formats::Environment& environment, bool mirrored,
                                      unsigned threads) {
    const runtime::LightVector light =
        runtime::project_environment(environment, asset.cubemap_size, {}, threads);
    runtime::ShadeOptions shading;
    runtime::SpecularLight lobes;
    if (mirrored) {
        lobes =
            runtime::make_specular_light(environment, runtime::specular_needs(asset), {}, threads);
        shading.terms = TermSet::specular;
        shading.specular = &lobes;
    }
    std::vector<double> luminance;
    for (const ReferenceReceiver& r : receivers) {
        formats::Rgb radiance;
        runtime::shade_range(asset, light, asset.primitives[r.primitive].first_vertex + r.vertex,
                             {&radiance, 1}, shading);
        luminance.push_back(static_cast<double>(formats::luminance(radiance)));
    }
    return luminance;
}

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
        const auto check =
            check_light({scene, sampler, paths}, mirrors,
                        relight_receivers(asset, mirrors, light.environment, true, context.threads),
                        options, context);
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

// Mean luminance of what is not compared.
formats::Result<double> measure_missing(const PathSpace& space,
                                        std::span<const ReferenceReceiver> receivers,
                                        const ModelCheckOptions& options, const Context& context) {
    PathSpace other = space;
    other.options.terms = TermSet::all & ~TermSet::specular & ~options.simulated;
    EstimateOptions wanted;
    wanted.seed = options.seed;
    wanted.samples = 256;
    const auto estimate = estimate_luminance(other, receivers, wanted, context);
    if (!estimate) {
        return estimate.error();
    }
    double sum = 0;
    for (const Moments& m : estimate->pixel) {
        sum += m.mean.x;
    }
    return sum / static_cast<double>(receivers.size());
}

}  // namespace

formats::Result<ModelErrorReport> check_model(const formats::Scene& given,
                                              const formats::AssetView& asset,
                                              const ModelCheckOptions& options,
                                              const Context& context) {
    const auto start = std::chrono::steady_clock::now();
    const OrientedBodies bodies = orient_bodies(given);
    auto scene = make_reference_scene(bodies.scene ? *bodies.scene : given, context.threads);
    if (!scene) {
        return std::move(scene).error();
    }
    ModelErrorReport report;
    report.reference =
        "path tracing; luminance along the normals of light that met one surface or body, "
        "without mirror reflection and what crosses a body unscattered";
    const auto lights = make_model_lights(!refracts(given), report.left_out);
    if (!lights) {
        return lights.error();
    }
    const std::vector<ReferenceReceiver> receivers =
        choose_model_receivers(*scene, options.receivers, options.seed);
    report.receivers_checked = static_cast<std::uint32_t>(receivers.size());
    if (receivers.empty()) {
        return report;
    }
    PathOptions paths;
    paths.terms = options.simulated;
    paths.own_mirror = false;
    std::vector<ModelPair> pairs;  // light by light
    for (const ModelLight& light : *lights) {
        const LightSampler sampler = make_light_sampler(light.environment, glm::mat3(1.0f));
        const PathSpace space{*scene, sampler, paths};
        const auto check = check_light(
            space, receivers,
            relight_receivers(asset, receivers, light.environment, false, context.threads), options,
            context);
        if (!check) {
            return check.error();
        }
        const auto missing = measure_missing(space, receivers, options, context);
        if (!missing) {
            return missing.error();
        }
        const MeanSquares sum = sum_up(check->pairs);
        const double total = sum.mean_truth / sum.count + *missing;
        report.by_light.push_back({light.name, sum.rms_relative(), sum.bias(),
                                   total > 0 ? *missing / total : 0, sum.noise(), check->samples});
        report.missing += report.by_light.back().missing / static_cast<double>(lights->size());
        report.samples += std::uint64_t{check->samples} * receivers.size();
        pairs.insert(pairs.end(), check->pairs.begin(), check->pairs.end());
    }
    const MeanSquares all = sum_up(pairs);
    report.rms_relative = all.rms_relative();
    report.bias = all.bias();
    std::ranges::copy(model_interval(pairs, receivers.size(), options.seed), report.ci95);
    if (const auto mirrors = find_mirrors(asset, receivers); !mirrors.empty()) {
        auto mirrored = check_mirrors(*scene, asset, mirrors, *lights, options, context);
        if (!mirrored) {
            return std::move(mirrored).error();
        }
        report.mirrored = *mirrored;
    }
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

}  // namespace opaline::bake
