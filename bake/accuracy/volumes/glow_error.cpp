#include "bake/accuracy/volumes/glow_error.h"

#include <algorithm>
#include <vector>

#include "bake/accuracy/model_pairs.h"
#include "bake/accuracy/volumes/volume_radiance.h"

namespace opaline::bake {
namespace {

// The same volumes among surfaces that neither reflect nor send out light.
formats::Scene with_black_surfaces(const formats::Scene& scene) {
    formats::Scene black = scene;
    formats::Material dark;
    dark.base_color = {0, 0, 0};
    dark.double_sided = true;
    std::ranges::fill(black.materials, dark);
    black.lights.clear();
    return black;
}

MeanSquares compare(std::span<const double> luminance, const VolumeTruth& truth) {
    std::vector<ModelPair> pairs;
    for (std::size_t i = 0; i < luminance.size(); ++i) {
        const double mean = truth.luminance[i].mean.x;
        pairs.push_back({luminance[i] - mean, mean, truth.luminance[i].variance_of_mean().x});
    }
    return sum_up(pairs);
}

}  // namespace

formats::Result<GlowErrorReport> check_glow(const formats::Scene& scene,
                                            const formats::AssetView& asset,
                                            const VolumeCheckOptions& options,
                                            const Context& context) {
    const formats::Scene black = with_black_surfaces(scene);
    const auto reference = make_reference_scene(black, context.threads);
    if (!reference) {
        return reference.error();
    }
    GlowErrorReport report;
    const std::vector<VolumeProbe> probes =
        choose_volume_probes(*reference, options.probes, options.seed);
    if (probes.empty()) {
        return report;
    }
    const std::vector<double> luminance =
        march_glow(asset.volumes, scene.origin, probes, context.threads);
    const auto truth = trace_volume_truth(
        *reference, probes, options.seed, options.max_events,
        [&](const VolumeTruth& so_far) {
            const MeanSquares sum = compare(luminance, so_far);
            return sum.noise() <= std::max(options.noise, options.noise_share * sum.rms_relative());
        },
        context, TermSet::emitters);
    if (!truth) {
        return truth.error();
    }
    const MeanSquares sum = compare(luminance, *truth);
    report.rms_relative = sum.rms_relative();
    report.bias = sum.bias();
    report.noise = sum.noise();
    report.rays_checked = static_cast<std::uint32_t>(luminance.size());
    report.events = truth->events;
    return report;
}

}  // namespace opaline::bake
