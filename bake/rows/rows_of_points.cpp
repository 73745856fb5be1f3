#include "bake/rows/rows_of_points.h"

#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/rows/gather_rows.h"

namespace opaline::bake {

void forget_samples(SubjectState& subject) {
    for (EffectState& effect : subject.effects) {
        effect.samples.reset();
        effect.prepared.reset();
    }
}

// One subject at a time, so that samples of one medium alone are in memory.
std::vector<std::vector<float>> rows_of_points(const BakeInputs& bake, const Knobs& knobs,
                                               const Context& context, SubjectState& subject,
                                               std::span<const Receiver> outside,
                                               std::span<const BodyPoint> inside,
                                               std::uint64_t& rays) {
    std::vector<SubjectState> alone;
    alone.push_back(std::move(subject));
    std::vector<std::vector<float>> rows(outside.size());
    for (std::vector<float>& row : rows) {
        shape_row(alone.front().layout, knobs.cubemap_size, row);
    }
    StageLog unlisted;
    run_step(Step::samples, bake, knobs, context, alone, unlisted);
    run_step(Step::prepare, bake, knobs, context, alone, unlisted);
    for (const StageReport& stage : unlisted) {
        rays += stage.rays;
    }
    if (!context.cancelled()) {
        std::vector<Gatherer> gatherers = make_gatherers(bake, alone.front(), knobs, context);
        rays += gather_batches(gatherers, inside);
        constexpr std::size_t kBlock = 16;
        for_each_block_in_order(
            rows.size(), kBlock, context,
            [&](Range range) {
                std::uint64_t traced = 0;
                for (std::size_t i = range.begin; i < range.end; ++i) {
                    const DenseRow row =
                        shape_row(alone.front().layout, knobs.cubemap_size, rows[i]);
                    traced += gather_receiver(gatherers, outside[i], inside[i], i, row);
                }
                return traced;
            },
            [&](Range, std::uint64_t traced) { rays += traced; });
    }
    forget_samples(alone.front());
    subject = std::move(alone.front());
    return rows;
}

}  // namespace opaline::bake
