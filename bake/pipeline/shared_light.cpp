#include "bake/pipeline/shared_light.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/rows/gather_rows.h"

namespace opaline::bake {
namespace {

void forget_samples(SubjectState& subject) {
    for (EffectState& effect : subject.effects) {
        effect.samples.reset();
        effect.prepared.reset();
    }
}

// One subject at a time, so that samples of one medium alone are in memory.
std::vector<std::vector<float>> rows_of_points(const BakeInputs& bake, const Knobs& knobs,
                                               const Context& context,
                                               std::vector<SubjectState>& subjects,
                                               std::span<const Receiver> outside,
                                               std::span<const BodyPoint> inside,
                                               std::uint64_t& rays) {
    std::vector<std::vector<float>> rows(outside.size());
    StageLog unlisted;
    run_step(Step::samples, bake, knobs, context, subjects, unlisted);
    run_step(Step::prepare, bake, knobs, context, subjects, unlisted);
    for (const StageReport& stage : unlisted) {
        rays += stage.rays;
    }
    std::vector<Gatherer> gatherers = make_gatherers(bake, subjects.front(), knobs, context);
    rays += gather_batches(gatherers, inside);
    constexpr std::size_t kBlock = 16;
    for_each_block_in_order(
        rows.size(), kBlock, context,
        [&](Range range) {
            std::uint64_t traced = 0;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const DenseRow row =
                    shape_row(subjects.front().layout, knobs.cubemap_size, rows[i]);
                traced += gather_receiver(gatherers, outside[i], inside[i], i, row);
            }
            return traced;
        },
        [&](Range, std::uint64_t traced) { rays += traced; });
    return rows;
}

}  // namespace

Knobs coarse_knobs(const EffectTable& effects, const Knobs& knobs, std::uint32_t cubemap_size) {
    Knobs coarse = knobs;
    coarse.cubemap_size = cubemap_size;
    for (const EffectDescriptor& effect : effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            if (knob->words.empty()) {
                coarse.set(*knob, knob->preset.front());
            }
        }
    }
    return settle(std::move(coarse));
}

std::unique_ptr<OtherLight> find_shared_light(const BakeInputs& bake, const Knobs& knobs,
                                              const Context& context,
                                              std::span<const RowLayout> layouts,
                                              std::vector<SubjectState>& subjects, StageLog& log) {
    for (std::size_t e = 0; e < bake.effects.effects.size(); ++e) {
        const EffectDescriptor& effect = bake.effects.effects[e];
        std::vector<std::uint8_t> acts(layouts.size());
        for (const SubjectState& subject : subjects) {
            acts[subject.material] = subject.effects[e].acts ? 1 : 0;
        }
        if (effect.make_light == nullptr || std::ranges::count(acts, 1) == 0) {
            continue;
        }
        const std::string name(effect.name);
        auto light = run_stage(log, name, name + ": scatterers", [&](std::uint64_t& rays) {
            const auto rows_of_medium = [&](std::uint32_t material,
                                            std::span<const Receiver> outside,
                                            std::span<const BodyPoint> inside,
                                            std::uint32_t cubemap_size) {
                const auto own = std::ranges::find(subjects, material, &SubjectState::material);
                std::vector<SubjectState> alone;
                alone.push_back(std::move(*own));
                auto rows = rows_of_points(bake, coarse_knobs(bake.effects, knobs, cubemap_size),
                                           context, alone, outside, inside, rays);
                forget_samples(alone.front());
                *own = std::move(alone.front());
                return rows;
            };
            return effect.make_light({bake, knobs, context, layouts, acts, rows_of_medium}, rays);
        });
        if (light) {
            return light;
        }
    }
    return nullptr;
}

}  // namespace opaline::bake
