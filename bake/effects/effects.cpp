#include "bake/effects/effects.h"

#include <array>

#include "bake/effects/direct/direct.h"
#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/gloss/gloss.h"
#include "bake/effects/incident/incident.h"
#include "bake/effects/interreflection/interreflection.h"
#include "bake/effects/layers/layer_knobs.h"
#include "bake/effects/layers/plan_layers.h"
#include "bake/effects/local/local.h"
#include "bake/effects/multiple/multiple.h"
#include "bake/effects/multiple/rule_multiple.h"
#include "bake/effects/sheet/sheet.h"
#include "bake/effects/single/single.h"
#include "bake/effects/specular/specular.h"
#include "bake/effects/transmission/transmission.h"
#include "bake/effects/volumes/volume_effects.h"
#include "bake/effects/volumes/volume_knobs.h"

namespace opaline::bake {
namespace {

constexpr std::array<const KnobSpec*, 2> kOnceKnobs{&kVolumeSpacing, &kVolumeCoefficients};
constexpr std::array<const KnobSpec*, 4> kOftenKnobs{&kVolumeMethod, &kVolumeWalks, &kVolumePaths,
                                                     &kVolumeTerms};
constexpr std::array<const KnobSpec*, 2> kCloudKnobs{&kCloudStep, &kCloudNodes};
constexpr std::array<const KnobSpec*, 2> kEmitterKnobs{&kEmitterParticles, &kEmitterRays};

// Of other subjects than materials: decided without rules, and no part of rows of materials.
EffectDescriptor describe_other(Effect id, Subject::Kind kind, std::string_view name,
                                std::string_view help,
                                std::span<const KnobSpec* const> knobs = {}) {
    return {.id = id, .name = name, .help = help, .kind = kind, .knobs = knobs};
}

}  // namespace

const EffectTable& all_effects() {
    using enum Subject::Kind;
    static const std::array kDescriptors{
        describe_direct(Effect::direct),
        describe_sheet(Effect::sheet),
        describe_multiple(Effect::multiple),
        describe_single(Effect::single),
        describe_transmission(Effect::transmission),
        describe_local(Effect::local, spread_rules()),
        describe_specular(Effect::specular),
        describe_gloss(Effect::gloss),
        describe_interreflection(Effect::interreflection),
        describe_other(Effect::volume_single, volume, kOnceInVolumes,
                       "light scattered once in smoke or clouds", kOnceKnobs),
        describe_other(Effect::volume_multiple, volume, kOftenInVolumes,
                       "light scattered more than once in smoke or clouds", kOftenKnobs),
        describe_other(Effect::volume_surface, volume, kVolumesToSurfaces,
                       "light that smoke or clouds scatter to surfaces"),
        describe_other(Effect::surface_volume, volume, kSurfacesToVolumes,
                       "light that surfaces send to smoke or clouds"),
        describe_other(Effect::cloud, layer, kCloud,
                       "light scattered by the droplets of cloud layers", kCloudKnobs),
        describe_other(Effect::radiosity, layer, kRadiosity,
                       "light between cloud layers and the ground"),
        describe_other(Effect::emitters, emitter, kEmitters,
                       "light of lamps, glowing surfaces and lights in the scene", kEmitterKnobs),
        describe_incident(Effect::incident)};
    static const EffectTable kTable{kDescriptors};
    return kTable;
}

}  // namespace opaline::bake
