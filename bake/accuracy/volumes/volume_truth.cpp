#include "bake/accuracy/volumes/volume_truth.h"

#include <algorithm>

#include "bake/accuracy/volumes/see_through.h"
#include "bake/accuracy/volumes/volume_lights.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {

formats::Result<VolumeTruth> trace_volume_truth(
    const ReferenceScene& reference, std::span<const VolumeProbe> probes, std::uint64_t seed,
    std::uint64_t max_events, const std::function<bool(const VolumeTruth&)>& is_enough,
    const Context& context, TermSet terms) {
    const std::vector<formats::Environment> lights = make_volume_lights(probes);
    std::vector<LightSampler> samplers;
    samplers.reserve(lights.size());
    for (const formats::Environment& light : lights) {
        samplers.push_back(make_light_sampler(light, glm::mat3(1.0f)));
    }
    PathOptions paths;
    paths.terms = terms;
    paths.by_volumes = true;
    const auto count = static_cast<std::uint32_t>(kLightPlaces * probes.size());
    const auto sample = [&](std::uint32_t pixel, RandomStream& random) {
        const std::size_t place = pixel / probes.size(), probe = pixel % probes.size();
        const LightSampler& sampler = samplers[light_number(probe, probes.size(), place)];
        const VolumeRay& ray = probes[probe].ray[place];
        PathSample one = trace_ray({reference, sampler, paths}, ray.origin, ray.direction, random);
        one.radiance =
            glm::vec3(formats::luminance({one.radiance.x, one.radiance.y, one.radiance.z}));
        return one;
    };
    VolumeTruth truth;
    truth.luminance.resize(count);
    truth.through = see_through_scene(reference.surfaces.scene().volumes, probes);
    EstimateOptions wanted;
    wanted.seed = seed;
    wanted.samples = 16;
    while (count > 0) {
        wanted.first = truth.samples;
        const auto estimate = estimate_pixels(count, wanted, context, sample);
        if (!estimate) {
            return estimate.error();
        }
        truth.samples += wanted.samples;
        truth.events += estimate->events;
        for (std::uint32_t i = 0; i < count; ++i) {
            truth.luminance[i].merge(estimate->pixel[i]);
        }
        if (is_enough(truth)) {
            break;
        }
        const double done = truth.samples;
        const double affordable = done * static_cast<double>(max_events) /
                                  static_cast<double>(std::max<std::uint64_t>(truth.events, 1));
        wanted.samples = static_cast<std::uint32_t>(std::clamp(affordable - done, 0.0, done));
        if (wanted.samples < truth.samples / 8 + 1) {
            break;
        }
    }
    return truth;
}

}  // namespace opaline::bake
