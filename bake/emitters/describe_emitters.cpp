#include "bake/emitters/describe_emitters.h"

#include <array>

#include "bake/emitters/emitter_knobs.h"
#include "bake/volumes/volume_effects.h"

namespace opaline::bake {
namespace {

constexpr std::array<const KnobSpec*, 2> kKnobs{&kEmitterParticles, &kEmitterRays};

}  // namespace

EffectDescriptor describe_emitters(Effect id) {
    return {.id = id,
            .name = kEmitters,
            .help = "light of lamps, glowing surfaces and lights in the scene",
            .knobs = kKnobs,
            .concerns_emitters = true};
}

}  // namespace opaline::bake
