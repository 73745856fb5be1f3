#include "bake/pipeline/shared_light.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bake/rows/gather_rows.h"

namespace opaline::bake {
namespace {

using PointRows = std::vector<std::vector<float>>;

// Calls make() while only those effects of a subject act that `counts` holds for.
template <class Counts, class Make>
PointRows with_some(const EffectTable& effects, SubjectState& subject, Counts&& counts,
                    Make&& make) {
    std::vector<std::uint8_t> acted;
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        acted.push_back(subject.effects[e].acts ? 1 : 0);
        subject.effects[e].acts =
            subject.effects[e].acts && counts(effects.effects[e], subject.layout);
    }
    PointRows rows = make();
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        subject.effects[e].acts = acted[e] != 0;
    }
    return rows;
}

bool lets_cross(const EffectDescriptor& effect, const RowLayout&) {
    return effect.make_look_through != nullptr;
}

// Of light that is no environment's; where light leaves at its entry, others than the effect that
// adds it scale its row.
bool scatters(const EffectDescriptor& effect, const RowLayout& layout) {
    return !lets_cross(effect, layout) &&
           (effect.adds_other_light || (layout.at_entry && effect.add_at_entry != nullptr));
}

// Of the effect that lets light cross a subject's medium; empty where none acts.
LookThrough make_look(const BakeInputs& bake, const SubjectState& subject, const Knobs& knobs,
                      const Context& context) {
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        const EffectDescriptor& effect = bake.effects.effects[e];
        if (subject.effects[e].acts && effect.make_look_through != nullptr) {
            return effect.make_look_through(inputs_of(bake, subject, e, knobs, context));
        }
    }
    return {};
}

// Calls make(inputs) with what an effect may ask for.
template <class Make>
auto with_light_inputs(const LightRequest& request, std::vector<std::uint8_t> acts,
                       std::uint64_t& rays, Make&& make) {
    const BakeInputs& bake = request.bake;
    const Knobs& knobs = request.knobs;
    const auto subject_of = [&](std::uint32_t material) -> SubjectState& {
        return *std::ranges::find(request.subjects, material, &SubjectState::material);
    };
    const auto crossing_rows = [&](std::uint32_t material, std::span<const Receiver> outside,
                                   std::span<const BodyPoint> inside, std::uint32_t cubemap_size) {
        SubjectState& own = subject_of(material);
        return with_some(bake.effects, own, lets_cross, [&] {
            return rows_of_points(bake, coarse_knobs(bake.effects, knobs, cubemap_size),
                                  request.context, own, outside, inside, rays);
        });
    };
    const auto answer_of_medium =
        [&](std::uint32_t material, const OtherLight& columns, std::span<const Receiver> outside,
            std::span<const BodyPoint> inside, std::uint32_t cubemap_size) {
            BakeInputs lit = bake;
            lit.light = &columns;
            SubjectState& own = subject_of(material);
            return with_some(bake.effects, own, scatters, [&] {
                return rows_of_points(lit, coarse_knobs(bake.effects, knobs, cubemap_size),
                                      request.context, own, outside, inside, rays);
            });
        };
    const auto look_through = [&](std::uint32_t material) {
        const auto own = std::ranges::find(request.subjects, material, &SubjectState::material);
        return own == request.subjects.end()
                   ? LookThrough()
                   : make_look(bake, *own, coarse_knobs(bake.effects, knobs, knobs.cubemap_size),
                               request.context);
    };
    LightInputs inputs{bake,
                       knobs,
                       request.context,
                       request.layouts,
                       std::move(acts),
                       crossing_rows,
                       answer_of_medium,
                       look_through};
    inputs.onlookers = request.onlookers;
    return make(inputs);
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

std::unique_ptr<OtherLight> find_shared_light(const LightRequest& request) {
    const auto& effects = request.bake.effects.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        const EffectDescriptor& effect = effects[e];
        std::vector<std::uint8_t> acts(request.layouts.size());
        for (const SubjectState& subject : request.subjects) {
            acts[subject.material] = subject.effects[e].acts ? 1 : 0;
        }
        if (effect.make_light == nullptr || std::ranges::count(acts, 1) == 0) continue;
        const std::string name(effect.name);
        auto light = run_stage(request.log, name, name + ": scatterers", [&](std::uint64_t& rays) {
            return with_light_inputs(request, acts, rays, [&](const LightInputs& inputs) {
                return effect.make_light(inputs, rays);
            });
        });
        if (light) return light;
    }
    return nullptr;
}

std::shared_ptr<const BounceLight> find_surface_light(const LightRequest& request) {
    return run_stage(request.log, "surfaces that volumes see", "surface-volume: scatterers",
                     [&](std::uint64_t& rays) {
                         return with_light_inputs(
                             request, {}, rays, [&](const LightInputs& inputs) {
                                 return find_bounce_light(inputs, rays, Bounces::none);
                             });
                     });
}

}  // namespace opaline::bake
