#include "bake/pipeline/lit_media.h"

#include <algorithm>
#include <utility>

#include "bake/pipeline/shared_light.h"
#include "bake/rows/rows_of_points.h"

namespace opaline::bake {
namespace {

// Those of the coarsest preset, but for what the user gave.
Knobs coarse_of(const EffectTable& effects, const Knobs& knobs, std::uint32_t cubemap_size) {
    Knobs coarse = coarse_knobs(effects, knobs, cubemap_size);
    for (const KnobSpec* knob : knobs.given) {
        coarse.set(*knob, knobs[*knob]);
    }
    return coarse;
}

}  // namespace

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

LightMedium make_light_medium(const BakeInputs& bake, std::span<const PlanEntry> plan,
                              const Knobs& knobs, const Context& context,
                              std::vector<SubjectState>& subjects) {
    return [&bake, plan, &knobs, &context, &subjects](const MediumRequest& request,
                                                      std::uint64_t& rays) {
        const auto own = std::ranges::find(subjects, request.material, &SubjectState::material);
        if (own == subjects.end() ||
            !takes_other_light(bake.effects, entries_of(plan, request.material), own->layout)) {
            return std::vector<std::vector<float>>();
        }
        BakeInputs lit = bake;
        lit.light = &request.light;
        Knobs chosen =
            request.is_coarse ? coarse_of(bake.effects, knobs, request.cubemap_size) : knobs;
        chosen.cubemap_size = request.cubemap_size;
        std::vector<SubjectState> alone;
        alone.push_back(std::move(*own));
        settle_subjects(lit, plan, chosen, alone);
        alone.front().layout = lit_layout(alone.front().layout);
        auto rows = rows_of_points(lit, chosen, context, alone.front(), request.outside,
                                   request.inside, rays);
        *own = std::move(alone.front());
        return rows;
    };
}

}  // namespace opaline::bake
