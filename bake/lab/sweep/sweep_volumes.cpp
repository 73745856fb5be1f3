#include "bake/lab/sweep/sweep_volumes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/base/stage_log.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kProbes = 64;

void take_bounds(const VolumeErrorReport& from, double& rms, double (&ci95)[2]) {
    rms = from.rms_relative;
    std::ranges::copy(from.ci95, ci95);
}

}  // namespace

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
