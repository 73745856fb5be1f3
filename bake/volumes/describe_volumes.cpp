#include "bake/volumes/describe_volumes.h"

#include <array>

#include "bake/volumes/volume_effects.h"
#include "bake/volumes/volume_knobs.h"

namespace opaline::bake {
namespace {

constexpr std::array<const KnobSpec*, 2> kKnobsOnce{&kVolumeSpacing, &kVolumeCoefficients};
constexpr std::array<const KnobSpec*, 4> kKnobsOften{&kVolumeMethod, &kVolumeWalks, &kVolumePaths,
                                                     &kVolumeTerms};

}  // namespace

EffectDescriptor describe_scattered_once(Effect id) {
    return {.id = id,
            .name = kOnceInVolumes,
            .help = "light scattered once in smoke or clouds",
            .knobs = kKnobsOnce,
            .concerns_volumes = true};
}

EffectDescriptor describe_scattered_often(Effect id) {
    return {.id = id,
            .name = kOftenInVolumes,
            .help = "light scattered more than once in smoke or clouds",
            .knobs = kKnobsOften,
            .concerns_volumes = true};
}

EffectDescriptor describe_sent_light(Effect id) {
    return {.id = id,
            .name = kVolumesToSurfaces,
            .help = "light that smoke or clouds scatter to surfaces",
            .concerns_volumes = true};
}

EffectDescriptor describe_seen_light(Effect id) {
    return {.id = id,
            .name = kSurfacesToVolumes,
            .help = "light that surfaces send to smoke or clouds",
            .concerns_volumes = true};
}

}  // namespace opaline::bake
