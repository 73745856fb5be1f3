#include "bake/effects/rows/medium_rows.h"

#include <algorithm>
#include <utility>

#include "bake/effects/rows/gather_rows.h"
#include "bake/exchange/other_light.h"

namespace opaline::bake {
namespace {

// Rows of points while only those effects of a subject act that `counts` holds for.
template <class Counts>
std::vector<std::vector<float>> rows_of_some(const BakeInputs& bake, const Knobs& knobs,
                                             const Context& context, SubjectState& subject,
                                             const ReceiverSet& at, Counts&& counts,
                                             std::uint64_t& rays) {
    std::vector<std::uint8_t> acted;
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        acted.push_back(subject.effects[e].acts ? 1 : 0);
        subject.effects[e].acts = subject.effects[e].acts && counts(bake.effects.effects[e]);
    }
    auto rows = rows_of_points(bake, knobs, context, subject, at.outside, at.inside, rays);
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        subject.effects[e].acts = acted[e] != 0;
    }
    return rows;
}

bool lets_cross(const EffectDescriptor& effect) {
    return effect.look_through != nullptr;
}

// Where light leaves at its entry, others than the effect that adds it scale its row.
bool adds_light(const RowLayout& layout, const EffectDescriptor& effect) {
    return effect.adds_other_light || (layout.at_entry && effect.add_at_entry != nullptr);
}

auto find_subject(const FinishedMedia& media, std::uint32_t material) {
    return std::ranges::find(media.subjects, material, &SubjectState::material);
}

// Rows of points under other light than that of the file, by those effects that `counts` holds for.
template <class Counts>
std::vector<std::vector<float>> rows_under(const FinishedMedia& media, const MediumRequest& request,
                                           SubjectState& own, Counts&& counts,
                                           const Context& context, std::uint64_t& rays) {
    BakeInputs lit = media.bake;
    lit.light = &request.light;
    Knobs knobs = media.knobs;
    knobs.cubemap_size = request.cubemap_size;
    std::vector<SubjectState> alone;
    alone.push_back(std::move(own));
    SubjectState& subject = alone.front();
    settle_subjects(media.bake, media.plan, knobs, alone);
    subject.layout = lit_layout(subject.layout);
    auto rows = rows_of_some(
        lit, knobs, context, subject,
        {.material = request.material,
         .outside = {request.outside.begin(), request.outside.end()},
         .inside = {request.inside.begin(), request.inside.end()}},
        [&](const EffectDescriptor& effect) { return counts(subject.layout, effect); }, rays);
    own = std::move(subject);
    return rows;
}

// What effects say at points of one medium.
MediumRows ask_medium(const BakeInputs& bake, const Knobs& knobs, const Context& context,
                      SubjectState& own, const OtherLight& patches, const ReceiverSet& at,
                      std::uint64_t& rays) {
    const Knobs coarse = coarse_knobs(bake.effects, knobs, kBounceCubemap);
    BakeInputs lit = bake;
    lit.light = &patches;
    const auto scatters = [&](const EffectDescriptor& effect) {
        return !lets_cross(effect) && adds_light(own.layout, effect);
    };
    MediumRows rows{rows_of_some(lit, coarse, context, own, at, scatters, rays), {}, {}};
    for (std::size_t e = 0; e < own.effects.size(); ++e) {
        const EffectDescriptor& effect = bake.effects.effects[e];
        if (!own.effects[e].acts || !lets_cross(effect)) continue;
        rows.crossing = rows_of_some(bake, coarse, context, own, at, lets_cross, rays);
        const Knobs views = coarse_knobs(bake.effects, knobs, knobs.cubemap_size);
        rows.through =
            effect.look_through(inputs_of(bake, own, e, views, context), at.inside, rays);
        break;
    }
    return rows;
}

// Rows of the members from `begin` on, of `count`; what is empty stays so.
void put_rows(MediumRows part, std::size_t begin, std::size_t count, MediumRows& all) {
    const auto put = [&](auto& from, auto& to) {
        if (from.empty()) return;
        to.resize(count);
        std::ranges::move(from, to.begin() + static_cast<std::ptrdiff_t>(begin));
    };
    put(part.scattered, all.scattered);
    put(part.crossing, all.crossing);
    put(part.through, all.through);
}

}  // namespace

Knobs coarse_knobs(const EffectTable& effects, const Knobs& knobs, std::uint32_t cubemap_size) {
    Knobs coarse = knobs;
    coarse.cubemap_size = cubemap_size;
    for (const EffectDescriptor& effect : effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            if (!knob->words.empty()) continue;
            const double few = knob->coarse != 0 ? knob->coarse : knob->preset.front();
            coarse.set(*knob, knob->theory.fine_is_small ? few : std::min(few, knobs[*knob]));
        }
    }
    return settle(std::move(coarse));
}

std::vector<MediumRows> ask_media(const BakeInputs& bake, const Knobs& knobs,
                                  const Context& context, const ExchangePoints& points,
                                  std::vector<SubjectState>& subjects, std::uint64_t& rays) {
    std::vector<MediumRows> rows;
    for (const MediumAnswer& medium : points.media) {
        const PatchLight columns = points.light_of(medium);
        const OtherLight patches{.patches = &columns, .bands = 1, .environment = false};
        MediumRows& all = rows.emplace_back();
        const std::size_t count = medium.members.size();
        for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
            const std::uint32_t material = points.material_of(medium, begin);
            ReceiverSet at;
            for (; end < count && points.material_of(medium, end) == material; ++end) {
                const Scatterer& s = points.scatterers[medium.members[end]];
                at.outside.push_back(s.outside);
                at.inside.push_back(s.inside);
            }
            SubjectState& own = *std::ranges::find(subjects, material, &SubjectState::material);
            put_rows(ask_medium(bake, knobs, context, own, patches, at, rays), begin, count, all);
        }
    }
    return rows;
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
    const auto own = find_subject(media, request.material);
    if (own == media.subjects.end() ||
        !takes_other_light(media.bake.effects, entries_of(media.plan, request.material),
                           own->layout)) {
        return {};
    }
    return rows_under(media, request, *own, adds_light, context, rays);
}

bool lets_light_cross(const EffectTable& effects, std::span<const PlanEntry> decisions,
                      const RowLayout& layout) {
    return layout.translucent &&
           std::ranges::any_of(effects.effects, [&](const EffectDescriptor& effect) {
               return lets_cross(effect) && acts_on(effect, decisions, layout);
           });
}

std::vector<std::vector<float>> light_through_medium(const FinishedMedia& media,
                                                     const MediumRequest& request,
                                                     const Context& context, std::uint64_t& rays) {
    const auto own = find_subject(media, request.material);
    if (own == media.subjects.end() ||
        !lets_light_cross(media.bake.effects, entries_of(media.plan, request.material),
                          own->layout)) {
        return {};
    }
    const auto crosses = [](const RowLayout&, const EffectDescriptor& effect) {
        return lets_cross(effect);
    };
    return rows_under(media, request, *own, crosses, context, rays);
}

}  // namespace opaline::bake
