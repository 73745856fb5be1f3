#include "bake/layers/describe_layers.h"

#include <array>

#include "bake/layers/layer_knobs.h"
#include "bake/layers/plan_layers.h"

namespace opaline::bake {
namespace {

constexpr std::array<const KnobSpec*, 2> kCloudKnobs{&kCloudStep, &kCloudNodes};

}  // namespace

EffectDescriptor describe_cloud(Effect id) {
    return {.id = id,
            .name = kCloud,
            .help = "light scattered by the droplets of cloud layers",
            .knobs = kCloudKnobs,
            .concerns_layers = true};
}

EffectDescriptor describe_radiosity(Effect id) {
    return {.id = id,
            .name = kRadiosity,
            .help = "light between cloud layers and the ground",
            .concerns_layers = true};
}

}  // namespace opaline::bake
