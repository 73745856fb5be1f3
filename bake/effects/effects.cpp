#include "bake/effects/effects.h"

#include <array>

#include "bake/effects/direct/direct.h"
#include "bake/effects/gloss/gloss.h"
#include "bake/effects/incident/incident.h"
#include "bake/effects/interreflection/interreflection.h"
#include "bake/effects/local/local.h"
#include "bake/effects/multiple/multiple.h"
#include "bake/effects/multiple/rule_spread.h"
#include "bake/effects/sheet/sheet.h"
#include "bake/effects/single/single.h"
#include "bake/effects/specular/specular.h"
#include "bake/effects/transmission/transmission.h"
#include "bake/emitters/plan_emitters.h"
#include "bake/layers/describe_layers.h"
#include "bake/volumes/describe_volumes.h"

namespace opaline::bake {

const EffectTable& all_effects() {
    static const std::array kDescriptors{describe_direct(Effect::direct),
                                         describe_sheet(Effect::sheet),
                                         describe_multiple(Effect::multiple),
                                         describe_single(Effect::single),
                                         describe_transmission(Effect::transmission),
                                         describe_local(Effect::local, spread_rules()),
                                         describe_specular(Effect::specular),
                                         describe_gloss(Effect::gloss),
                                         describe_interreflection(Effect::interreflection),
                                         describe_scattered_once(Effect::volume_single),
                                         describe_scattered_often(Effect::volume_multiple),
                                         describe_sent_light(Effect::volume_surface),
                                         describe_seen_light(Effect::surface_volume),
                                         describe_cloud(Effect::cloud),
                                         describe_radiosity(Effect::radiosity),
                                         describe_emitters(Effect::emitters),
                                         describe_incident(Effect::incident)};
    static const EffectTable kTable{kDescriptors};
    return kTable;
}

}  // namespace opaline::bake
