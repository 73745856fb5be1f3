#include "bake/rows/medium_rows.h"

#include <algorithm>
#include <utility>

#include "bake/rows/gather_rows.h"

namespace opaline::bake {
namespace {

// coarse_knobs, but for what the user gave.
Knobs coarse_of(const EffectTable& effects, const Knobs& knobs, std::uint32_t cubemap_size) {
    Knobs coarse = coarse_knobs(effects, knobs, cubemap_size);
    for (const KnobSpec* knob : knobs.given) {
        coarse.set(*knob, knobs[*knob]);
    }
    return coarse;
}

}  // namespace

Knobs coarse_knobs(const EffectTable& effects, const Knobs& knobs, std::uint32_t cubemap_size) {
    Knobs coarse = knobs;
    coarse.cubemap_size = cubemap_size;
    for (const EffectDescriptor& effect : effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            if (knob->words.empty()) {
                coarse.set(*knob, knob->coarse != 0 ? knob->coarse : knob->preset.front());
            }
        }
    }
    return settle(std::move(coarse));
}

bool takes_other_light(const EffectTable& effects, std::span<const PlanEntry> decisions,
                       const RowLayout& layout) {
    return layout.translucent && layout.constant &&
           std::ranges::any_of(effects.effects, [&](const EffectDescriptor& effect) {
               return effect.adds_other_light && effect.gather.add != nullptr &&
                      acts_on(effect, decisions, layout);
           });
}

RowLayout lit_layout(RowLayout layout) {
    layout.coloured = layout.constant;
    return layout;
}

std::vector<std::vector<float>> light_medium(const FinishedMedia& media,
                                             const MediumRequest& request, const Context& context,
                                             std::uint64_t& rays) {
    const EffectTable& effects = media.bake.effects;
    const auto own = std::ranges::find(media.subjects, request.material, &SubjectState::material);
    if (own == media.subjects.end() ||
        !takes_other_light(effects, entries_of(media.plan, request.material), own->layout)) {
        return {};
    }
    BakeInputs lit = media.bake;
    lit.light = &request.light;
    Knobs knobs =
        request.is_coarse ? coarse_of(effects, media.knobs, request.cubemap_size) : media.knobs;
    knobs.cubemap_size = request.cubemap_size;
    std::vector<SubjectState> alone;
    alone.push_back(std::move(*own));
    settle_subjects(lit, media.plan, knobs, alone);
    alone.front().layout = lit_layout(alone.front().layout);
    auto rows =
        rows_of_points(lit, knobs, context, alone.front(), request.outside, request.inside, rays);
    *own = std::move(alone.front());
    return rows;
}

}  // namespace opaline::bake
