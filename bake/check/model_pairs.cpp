#include "bake/check/model_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bake/check/bootstrap.h"
#include "bake/check/check_model.h"
#include "bake/lights/builtin_environment.h"
#include "bake/lights/test_lights.h"
#include "bake/reference/reference_receivers.h"
#include "bake/scene/orient_bodies.h"
#include "formats/opal/rgb.h"
#include "runtime/shade.h"

namespace opaline::bake {
namespace {

// Light that met more than one body and crossed one of them unscattered is in files that hold both.
bool holds_crossed_light(TermSet compared) {
    return has_all(compared, TermSet::interreflection | TermSet::unscattered);
}

// Mean luminance of the light that is not compared. Light of the scene's own emitters does not
// depend on the environment and is left out.
formats::Result<double> measure_missing(const PathSpace& space,
                                        std::span<const ReferenceReceiver> receivers,
                                        TermSet compared, EstimateOptions wanted,
                                        const Context& context) {
    PathSpace other = space;
    other.options.terms = TermSet::all & ~TermSet::specular & ~TermSet::emitters & ~compared;
    if (has_any(compared, TermSet::interreflection) && !holds_crossed_light(compared)) {
        other.options.terms |= TermSet::interreflection;
        other.options.crossed = CrossedLight::alone;
    }
    const auto estimate = estimate_luminance(other, receivers, wanted, context);
    if (!estimate) return estimate.error();
    double sum = 0;
    for (const Moments& m : estimate->pixel) {
        sum += m.mean.x;
    }
    return receivers.empty() ? 0 : sum / static_cast<double>(receivers.size());
}

// Far from the point, in direction `to_eye`.
formats::Vec3 far_eye(formats::Vec3 point, glm::vec3 to_eye) {
    const float away = 1 + std::abs(point.x) + std::abs(point.y) + std::abs(point.z);
    return point + away * formats::Vec3{to_eye.x, to_eye.y, to_eye.z};
}

}  // namespace

void MeanSquares::add(const ModelPair& p) {
    difference += p.difference * p.difference - p.variance;
    truth += p.truth * p.truth - p.variance;
    variance += p.variance;
    mean_difference += p.difference;
    mean_truth += p.truth;
    count += 1;
}

double MeanSquares::share_of_truth(double square) const {
    return truth > 0 ? std::sqrt(std::max(0.0, square) / truth) : 0;
}

MeanSquares sum_up(std::span<const ModelPair> pairs) {
    MeanSquares sum;
    for (const ModelPair& p : pairs) {
        sum.add(p);
    }
    return sum;
}

std::array<double, 2> model_interval(std::span<const ModelPair> pairs, std::size_t receivers,
                                     std::uint64_t seed) {
    return bootstrap_interval(receivers, seed, [&](std::span<const std::size_t> drawn) {
        MeanSquares sum;
        for (const std::size_t r : drawn) {
            for (std::size_t at = r; at < pairs.size(); at += receivers) {
                sum.add(pairs[at]);
            }
        }
        return sum.rms_relative();
    });
}

std::vector<PathSpace> held_light_spaces(const ModelScenes& scenes, const LightSampler& sampler,
                                         const ModelCheckOptions& options) {
    PathOptions paths;
    paths.terms = options.simulated;
    paths.own_mirror = false;
    paths.crossed =
        holds_crossed_light(options.simulated) ? CrossedLight::counted : CrossedLight::left_out;
    if (!options.lit_by_volumes || !scenes.without_scattering) {
        return {{scenes.held(), sampler, paths}};
    }
    PathOptions through = paths, between = paths;
    through.terms = options.simulated & ~TermSet::interreflection;
    through.through_volumes = true;
    through.by_volumes = true;
    if (options.volumes_see_surfaces) {
        through.terms = through.terms | TermSet::interreflection;
    }
    between.terms = options.simulated & TermSet::interreflection;
    std::vector<PathSpace> spaces{{scenes.whole, sampler, through}};
    if (between.terms != TermSet::none) {
        spaces.push_back({scenes.held(), sampler, between});
    }
    return spaces;
}

std::uint64_t seed_of_space(std::uint64_t seed, std::size_t space) {
    return seed + space * 0x9e3779b97f4a7c15u;
}

formats::Result<LightCheck> check_light(std::span<const PathSpace> spaces,
                                        std::span<const ReferenceReceiver> receivers,
                                        std::span<const double> baked,
                                        const ModelCheckOptions& options, const Context& context) {
    LightCheck check;
    check.pairs.resize(receivers.size());
    if (receivers.empty()) return check;
    std::vector<std::vector<Moments>> moments(spaces.size(),
                                              std::vector<Moments>(receivers.size()));
    std::uint64_t events = 0;
    EstimateOptions wanted;
    wanted.samples = 64;
    while (true) {
        wanted.first = check.samples;
        check.samples += wanted.samples;
        for (std::size_t s = 0; s < spaces.size(); ++s) {
            wanted.seed = seed_of_space(options.seed, s);
            const auto estimate = estimate_luminance(spaces[s], receivers, wanted, context);
            if (!estimate) return estimate.error();
            events += estimate->events;
            for (std::size_t i = 0; i < receivers.size(); ++i) {
                moments[s][i].merge(estimate->pixel[i]);
            }
        }
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            double truth = 0, variance = 0;
            for (const std::vector<Moments>& own : moments) {
                truth += own[i].mean.x;
                variance += own[i].variance_of_mean().x;
            }
            check.pairs[i] = {baked[i] - truth, truth, variance};
        }
        const MeanSquares sum = sum_up(check.pairs);
        if (sum.noise() <= std::max(options.noise, options.noise_share * sum.rms_relative())) {
            return check;
        }
        const double done = check.samples;
        const double affordable = done * static_cast<double>(options.max_events) /
                                  static_cast<double>(std::max<std::uint64_t>(events, 1));
        wanted.samples = static_cast<std::uint32_t>(std::clamp(affordable - done, 0.0, done));
        if (wanted.samples < check.samples / 8 + 1) return check;
    }
}

formats::Result<LightCheck> check_unmirrored(const ModelScenes& scenes, const ModelLight& light,
                                             std::span<const ReferenceReceiver> receivers,
                                             std::span<const double> baked,
                                             const ModelCheckOptions& options,
                                             const Context& context) {
    const LightSampler sampler = make_light_sampler(light.environment, glm::mat3(1.0f));
    const std::vector<PathSpace> held = held_light_spaces(scenes, sampler, options);
    auto check = check_light(held, receivers, baked, options, context);
    if (!check) return check;
    // Volumes send light along all kinds of paths: trace all of it, less the light that the file
    // holds.
    const bool has_volumes = scenes.without_scattering.has_value();
    EstimateOptions wanted;
    wanted.seed = options.seed;
    wanted.samples = has_volumes ? std::max(256u, check->samples) : 256;
    PathOptions all;
    all.own_mirror = false;
    const auto missing =
        measure_missing({scenes.whole, sampler, all}, receivers,
                        has_volumes ? TermSet::none : options.simulated, wanted, context);
    if (!missing) return missing.error();
    check->light = light.name;
    check->missing = *missing;
    if (has_volumes && !receivers.empty()) {
        const MeanSquares sum = sum_up(check->pairs);
        check->missing = std::max(0.0, *missing - sum.mean_truth / sum.count);
    }
    check->terms = options.simulated;
    return check;
}

ModelErrorReport make_model_report(std::span<const LightCheck> checks, std::size_t receivers,
                                   std::uint64_t seed) {
    ModelErrorReport report;
    report.reference =
        "path tracing; luminance along the normals of light that met one surface or body, "
        "without mirror reflection";
    if (!checks.empty() && !has_any(checks.front().terms, TermSet::unscattered)) {
        report.reference += " and what crosses a body unscattered";
    }
    report.receivers_checked = static_cast<std::uint32_t>(receivers);
    if (receivers == 0) return report;
    std::vector<ModelPair> pairs;  // light by light
    for (const LightCheck& check : checks) {
        const MeanSquares sum = sum_up(check.pairs);
        const double total = sum.mean_truth / sum.count + check.missing;
        report.by_light.push_back({check.light, sum.rms_relative(), sum.bias(),
                                   total > 0 ? check.missing / total : 0, sum.noise(),
                                   check.samples});
        report.missing += report.by_light.back().missing / static_cast<double>(checks.size());
        report.samples += std::uint64_t{check.samples} * receivers;
        pairs.insert(pairs.end(), check.pairs.begin(), check.pairs.end());
    }
    const MeanSquares all = sum_up(pairs);
    report.rms_relative = all.rms_relative();
    report.bias = all.bias();
    std::ranges::copy(model_interval(pairs, receivers, seed), report.ci95);
    return report;
}

bool has_refraction(const formats::Scene& scene) {
    return std::any_of(scene.primitives.begin(), scene.primitives.end(), [&](const auto& p) {
        const auto& medium = scene.materials[p.material].medium;
        return medium && !p.index.empty() && !is_matched(medium->eta);
    });
}

formats::Result<std::vector<ModelLight>> make_model_lights(const formats::Scene& scene,
                                                           std::vector<std::string>& left_out) {
    const bool with_suns = !has_refraction(scene);
    std::vector<ModelLight> lights;
    for (const char* name : published_lights()) {
        auto environment = make_environment(name);
        if (!environment) return std::move(environment).error();
        ModelLight light{name, std::move(*environment)};
        if (!with_suns && !light.environment.discs.empty()) {
            left_out.emplace_back(name);
            if (light.environment.pixel.empty()) continue;
            light.environment.discs.clear();
            light.name += " without its sun";
        }
        lights.push_back(std::move(light));
    }
    return lights;
}

std::vector<double> relight_receivers(const formats::AssetView& asset,
                                      std::span<const ReferenceReceiver> receivers,
                                      const FileLight& light) {
    runtime::ShadeOptions shading;
    shading.emitters = light.emitters;
    if (light.mirrored != nullptr) {
        shading.terms = TermSet::specular;
        shading.specular = light.mirrored;
    }
    std::vector<double> luminance;
    for (const ReferenceReceiver& r : receivers) {
        const std::uint32_t vertex = asset.primitives[r.primitive].first_vertex + r.vertex;
        shading.eye.reset();
        if (glm::dot(r.to_eye, r.normal) < 0) {
            shading.eye = far_eye(asset.position[vertex], r.to_eye);
        }
        formats::Rgb radiance;
        runtime::shade_range(asset, light.vector, vertex, {&radiance, 1}, shading);
        luminance.push_back(static_cast<double>(formats::luminance(radiance)));
    }
    return luminance;
}

formats::Result<ModelProbes> choose_model_probes(const formats::Scene& given,
                                                 std::uint32_t receivers, std::uint64_t seed,
                                                 const Context& context) {
    const OrientedBodies bodies = orient_bodies(given);
    const auto scene = make_reference_scene(bodies.scene ? *bodies.scene : given, context.threads);
    if (!scene) return scene.error();
    ModelProbes probes;
    auto lights = make_model_lights(given, probes.left_out);
    if (!lights) return std::move(lights).error();
    probes.lights = std::move(*lights);
    probes.receivers = choose_model_receivers(*scene, receivers, seed);
    return probes;
}

formats::Result<std::vector<LightCheck>> trace_model_truth(const formats::Scene& given,
                                                           const ModelProbes& probes,
                                                           const ModelCheckOptions& options,
                                                           const Context& context) {
    const auto scenes = make_model_scenes(given, context.threads);
    if (!scenes) return scenes.error();
    ModelCheckOptions alike = options;
    alike.noise_share = 0;  // of the files to come nothing is known
    const std::vector<double> black(probes.receivers.size());
    std::vector<LightCheck> truth;
    for (const ModelLight& light : probes.lights) {
        auto traced = check_unmirrored(*scenes, light, probes.receivers, black, alike, context);
        if (!traced) return std::move(traced).error();
        truth.push_back(std::move(*traced));
    }
    return truth;
}

ModelErrorReport compare_with_truth(std::span<const std::vector<double>> luminance,
                                    std::span<const LightCheck> truth, const ModelProbes& probes,
                                    std::uint64_t seed) {
    std::vector<LightCheck> checks(truth.begin(), truth.end());
    for (std::size_t l = 0; l < checks.size(); ++l) {
        for (std::size_t i = 0; i < checks[l].pairs.size(); ++i) {
            ModelPair& pair = checks[l].pairs[i];
            pair.difference = luminance[l][i] - pair.truth;
        }
    }
    ModelErrorReport report = make_model_report(checks, probes.receivers.size(), seed);
    report.left_out = probes.left_out;
    return report;
}

}  // namespace opaline::bake
