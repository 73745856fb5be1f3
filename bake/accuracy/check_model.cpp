#include "bake/accuracy/check_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "bake/accuracy/bootstrap.h"
#include "bake/accuracy/model_receivers.h"
#include "bake/environment/builtin_environment.h"
#include "bake/reference/reference_image.h"
#include "bake/scene/orient_bodies.h"
#include "bake/truth/test_lights.h"
#include "formats/opal/rgb.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"

namespace opaline::bake {
namespace {

/// One receiver under one light: luminance, and the variance of the true mean.
struct ModelPair {
    double difference = 0, truth = 0, variance = 0;
};

/// Mean squares minus the variance, because the square of a noisy value is too large by it.
struct MeanSquares {
    double difference = 0, truth = 0, variance = 0, mean_difference = 0, mean_truth = 0;
    double count = 0;

    void add(const ModelPair& p) {
        difference += p.difference * p.difference - p.variance;
        truth += p.truth * p.truth - p.variance;
        variance += p.variance;
        mean_difference += p.difference;
        mean_truth += p.truth;
        count += 1;
    }
    double rms_relative() const { return share_of_truth(difference); }
    double noise() const { return share_of_truth(variance); }
    double bias() const { return mean_truth > 0 ? mean_difference / mean_truth : 0; }

  private:
    double share_of_truth(double square) const {
        return truth > 0 ? std::sqrt(std::max(0.0, square) / truth) : 0;
    }
};

MeanSquares sum_up(std::span<const ModelPair> pairs) {
    MeanSquares sum;
    for (const ModelPair& p : pairs) {
        sum.add(p);
    }
    return sum;
}

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

// The file's luminance along the normals.
std::vector<double> relight_receivers(const formats::AssetView& asset,
                                      std::span<const ReferenceReceiver> receivers,
                                      const formats::Environment& environment, unsigned threads) {
    const runtime::LightVector light =
        runtime::project_environment(environment, asset.cubemap_size, {}, threads);
    std::vector<double> luminance;
    for (const ReferenceReceiver& r : receivers) {
        formats::Rgb radiance;
        runtime::shade_range(asset, light, asset.primitives[r.primitive].first_vertex + r.vertex,
                             {&radiance, 1});
        luminance.push_back(static_cast<double>(formats::luminance(radiance)));
    }
    return luminance;
}

/// The pairs of one light, one per receiver.
struct LightCheck {
    std::vector<ModelPair> pairs;
    std::uint32_t samples = 0;  ///< for each
};

// Doubles the samples until the noise is low enough or the next round exceeds the limit of work.
formats::Result<LightCheck> check_light(const PathSpace& space,
                                        std::span<const ReferenceReceiver> receivers,
                                        std::span<const double> baked,
                                        const ModelCheckOptions& options, const Context& context) {
    LightCheck check;
    check.pairs.resize(receivers.size());
    std::vector<Moments> moments(receivers.size());
    std::uint64_t events = 0;
    EstimateOptions wanted;
    wanted.seed = options.seed;
    wanted.samples = 64;
    while (true) {
        wanted.first = check.samples;
        const auto estimate = estimate_luminance(space, receivers, wanted, context);
        if (!estimate) {
            return estimate.error();
        }
        check.samples += wanted.samples;
        events += estimate->events;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            moments[i].merge(estimate->pixel[i]);
            const double truth = moments[i].mean.x;
            check.pairs[i] = {baked[i] - truth, truth, moments[i].variance_of_mean().x};
        }
        const MeanSquares sum = sum_up(check.pairs);
        if (sum.noise() <= std::max(options.noise, options.noise_share * sum.rms_relative())) {
            return check;
        }
        const double done = check.samples;
        const double affordable = done * static_cast<double>(options.max_events) /
                                  static_cast<double>(std::max<std::uint64_t>(events, 1));
        wanted.samples = static_cast<std::uint32_t>(std::clamp(affordable - done, 0.0, done));
        if (wanted.samples < check.samples / 8 + 1) {
            return check;
        }
    }
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
        const auto check =
            check_light(space, receivers,
                        relight_receivers(asset, receivers, light.environment, context.threads),
                        options, context);
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
    const auto interval =
        bootstrap_interval(receivers.size(), options.seed, [&](std::span<const std::size_t> drawn) {
            MeanSquares sum;
            for (const std::size_t r : drawn) {
                for (std::size_t l = 0; l < lights->size(); ++l) {
                    sum.add(pairs[l * receivers.size() + r]);
                }
            }
            return sum.rms_relative();
        });
    std::copy(interval.begin(), interval.end(), report.ci95);
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

}  // namespace opaline::bake
