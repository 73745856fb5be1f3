#include "bake/plan/effect.h"

#include <algorithm>
#include <cassert>

namespace opaline::bake {

const EffectDescriptor& EffectTable::operator[](Effect id) const {
    const auto found = std::find_if(effects.begin(), effects.end(),
                                    [&](const EffectDescriptor& e) { return e.id == id; });
    assert(found != effects.end());
    return *found;
}

bool takes_even_media(const EffectTable& effects, const Knobs& knobs) {
    return std::ranges::any_of(effects.effects, [&](const EffectDescriptor& effect) {
        return std::ranges::any_of(effect.knobs, [&](const KnobSpec* knob) {
            return knob->even_media > 0 && knobs[*knob] == knob->even_media;
        });
    });
}

const DecisionRule& rule_of(const EffectTable& effects, const PlanEntry& entry) {
    const EffectDescriptor& effect = effects[entry.effect];
    assert(entry.rule < effect.rules.size());
    return effect.rules[entry.rule];
}

bool acts_on(const EffectDescriptor& effect, std::span<const PlanEntry> decisions,
             const RowLayout& layout) {
    if (!effect.rules.empty() && effect.rules.front().name != effect.name) {
        return effect.gather.applies != nullptr && effect.gather.applies(layout);
    }
    return std::any_of(decisions.begin(), decisions.end(), [&](const PlanEntry& entry) {
        return entry.effect == effect.id && entry.rule == 0 && entry.on;
    });
}

}  // namespace opaline::bake
