#include "bake/lab/sweep/probes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/base/stage_log.h"
#include "bake/lights/test_lights.h"
#include "runtime/shade.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kProbes = 64;

void take_bounds(const VolumeErrorReport& from, double& rms, double (&ci95)[2]) {
    rms = from.rms_relative;
    std::ranges::copy(from.ci95, ci95);
}

}  // namespace

formats::Result<ProbeLights> make_probe_lights(std::uint32_t n, unsigned threads) {
    auto lights = make_test_lights(n, threads);
    if (!lights) return std::move(lights).error();
    ProbeLights probe;
    for (const TestLight& light : *lights) {
        runtime::LightVector vector{n, std::vector<float>(4 * light.coarse.size(), 0.0f)};
        for (std::size_t k = 0; k < light.coarse.size(); ++k) {
            std::fill_n(vector.rgba.begin() + static_cast<std::ptrdiff_t>(4 * k), 3,
                        light.coarse[k]);
        }
        probe.names.push_back(light.name);
        probe.vectors.push_back(std::move(vector));
    }
    return probe;
}

std::vector<std::uint32_t> choose_probes(std::size_t receivers, std::size_t most) {
    // Fractions of multiples of the golden ratio: no period that a mesh could share [Roberts2018].
    constexpr double kGolden = 1 / std::numbers::phi;
    const std::size_t count = std::min(receivers, most);
    std::vector<std::uint32_t> probes;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t begin = receivers * i / count, end = receivers * (i + 1) / count;
        const double place = std::fmod(kGolden * static_cast<double>(i + 1), 1.0);
        probes.push_back(static_cast<std::uint32_t>(
            begin + static_cast<std::size_t>(place * static_cast<double>(end - begin))));
    }
    return probes;
}

std::vector<double> relight_probes(const formats::AssetView& asset,
                                   std::span<const std::uint32_t> probes,
                                   const ProbeLights& lights) {
    runtime::ShadeOptions options;
    options.base_color = options.fresnel = false;
    options.emitters = runtime::dark_emitters();
    std::vector<double> luminance;
    luminance.reserve(probes.size() * lights.vectors.size());
    for (const std::uint32_t probe : probes) {
        for (const runtime::LightVector& light : lights.vectors) {
            formats::Rgb radiance;
            runtime::shade_range(asset, light, probe, std::span(&radiance, 1), options);
            luminance.push_back(static_cast<double>(formats::luminance(radiance)));
        }
    }
    return luminance;
}

ErrorReport compare_probes(std::span<const double> luminance, std::span<const double> truth,
                           std::span<const std::string> effect,
                           std::span<const std::string> lights) {
    std::vector<EffectCheck> checks;
    for (std::size_t p = 0; p < effect.size(); ++p) {
        auto own = std::find_if(checks.begin(), checks.end(),
                                [&](const EffectCheck& c) { return c.effect == effect[p]; });
        if (own == checks.end()) {
            own = checks.emplace(own);
            own->effect = effect[p];
            own->reference = "the most accurate bake of the sweep";
        }
        for (std::size_t l = 0; l < lights.size(); ++l) {
            const std::size_t i = p * lights.size() + l;
            own->pairs.push_back({{luminance[i] - truth[i], luminance[i] - truth[i]}, truth[i]});
        }
    }
    return summarise_checks(checks, lights, 0);
}

void add_error_of_truth(ErrorReport& error, const ErrorReport& truth) {
    const auto add = [](double& value, double more) { value = std::hypot(value, more); };
    const auto add_parts = [&](std::vector<ErrorReport::Part>& parts,
                               const std::vector<ErrorReport::Part>& more) {
        for (ErrorReport::Part& part : parts) {
            for (const ErrorReport::Part& own : more) {
                if (own.name == part.name) {
                    add(part.rms_relative, own.rms_relative);
                }
            }
        }
    };
    add(error.rms_relative, truth.rms_relative);
    add(error.ci95[1], truth.rms_relative);
    add_parts(error.by_effect, truth.by_effect);
    add_parts(error.by_light, truth.by_light);
}

double relative_difference(std::span<const double> luminance, std::span<const double> truth) {
    double error = 0, square = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        error += (luminance[i] - truth[i]) * (luminance[i] - truth[i]);
        square += truth[i] * truth[i];
    }
    return square > 0 ? std::sqrt(error / square) : 0.0;
}

formats::Result<SweepVolumes> make_sweep_volumes(const formats::Scene& scene, double seconds,
                                                 std::uint64_t seed, const Context& context) {
    SweepVolumes volumes;
    if (scene.volumes.empty()) return volumes;
    const auto reference = make_reference_scene(scene, context.threads);
    if (!reference) return reference.error();
    volumes.probes = choose_volume_probes(*reference, kProbes, seed);
    // A short run first, to find how much the time allows.
    constexpr std::uint64_t kFewEvents = 300000;
    constexpr double kMostTimes = 1000;
    const Clock::time_point start = Clock::now();
    const auto never = [](const VolumeTruth&) { return false; };
    auto truth = trace_volume_truth(*reference, volumes.probes, seed, kFewEvents, never, context);
    const double times = std::min(seconds / std::max(seconds_since(start), 1e-3), kMostTimes);
    if (truth && times >= 2) {
        truth = trace_volume_truth(
            *reference, volumes.probes, seed,
            static_cast<std::uint64_t>(times * static_cast<double>(kFewEvents)), never, context);
    }
    if (!truth) return std::move(truth).error();
    volumes.truth = std::move(*truth);
    for (std::size_t place = 0; place < kLightPlaces; ++place) {
        double square = 0;
        for (std::size_t p = 0; p < volumes.probes.size(); ++p) {
            const Moments& m = volumes.truth.luminance[place * volumes.probes.size() + p];
            square += m.mean.x * m.mean.x - m.variance_of_mean().x;
        }
        square /= static_cast<double>(std::max<std::size_t>(volumes.probes.size(), 1));
        volumes.scale[place] = square > 0 ? 1 / std::sqrt(square) : 0;
    }
    return volumes;
}

std::vector<double> relative_luminance(const SweepVolumes& volumes,
                                       std::span<const double> marched) {
    std::vector<double> relative;
    for (std::size_t p = 0; p < volumes.probes.size(); ++p) {
        for (std::size_t place = 0; place < kLightPlaces; ++place) {
            relative.push_back(volumes.scale[place] * marched[place * volumes.probes.size() + p]);
        }
    }
    return relative;
}

std::vector<std::string> volume_light_names() {
    return {kLightPlaceNames.begin(), kLightPlaceNames.end()};
}

ErrorReport as_error_report(const VolumeErrorReport& volumes) {
    ErrorReport error;
    take_bounds(volumes, error.rms_relative, error.ci95);
    error.receivers_checked = volumes.rays_checked;
    error.reference = volumes.reference;
    error.by_effect.push_back({"volumes", volumes.rms_relative});
    for (const VolumeErrorReport::Part& part : volumes.by_light) {
        error.by_light.push_back({part.name, part.rms_relative});
    }
    return error;
}

void take_larger(ErrorReport& error, const ErrorReport& volumes) {
    if (error.receivers_checked == 0 || volumes.rms_relative > error.rms_relative) {
        error.rms_relative = volumes.rms_relative;
        std::ranges::copy(volumes.ci95, error.ci95);
    }
    error.receivers_checked += volumes.receivers_checked;
    error.reference += (error.reference.empty() ? "" : "; volumes: ") + volumes.reference;
    std::ranges::copy(volumes.by_effect, std::back_inserter(error.by_effect));
    std::ranges::copy(volumes.by_light, std::back_inserter(error.by_light));
}

void take_larger(ModelErrorReport& error, const VolumeErrorReport& volumes) {
    if (error.receivers_checked == 0 || volumes.rms_relative > error.rms_relative) {
        take_bounds(volumes, error.rms_relative, error.ci95);
        error.bias = 0;
        for (const VolumeErrorReport::Part& part : volumes.by_light) {
            error.bias += part.bias / static_cast<double>(volumes.by_light.size());
        }
    }
    error.receivers_checked += volumes.rays_checked;
    error.samples += volumes.samples;
    error.reference +=
        (error.receivers_checked == volumes.rays_checked ? "" : "; volumes: ") + volumes.reference;
}

}  // namespace opaline::bake
