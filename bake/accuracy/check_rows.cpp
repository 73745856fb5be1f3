#include "bake/accuracy/check_rows.h"

#include <algorithm>

#include "bake/accuracy/stored_luminance.h"
#include "bake/accuracy/subject_truth.h"
#include "bake/base/ordered_parallel.h"
#include "bake/truth/draw_receivers.h"

namespace opaline::bake {
namespace {

EffectCheck check_subject(const BakeInputs& bake, const SubjectTruth& truth,
                          const SubjectState& subject, const formats::AssetView& asset,
                          std::span<const std::uint32_t> drawn,
                          std::span<const TestLight> lights) {
    struct Found {
        std::vector<CheckedPair> pairs;
        std::uint64_t rays = 0;
    };
    EffectCheck check{truth.name(), truth.reference(), {}, 0};
    const std::size_t step =
        truth.is_expensive() ? (drawn.size() + kMostExpensiveChecks - 1) / kMostExpensiveChecks : 1;
    for_each_block_in_order(
        drawn.size(), 1, truth.parts.front().inputs.context,
        [&](Range range) {
            Found found;
            const std::uint32_t v = drawn[range.begin];
            const ReceiverSet& set = set_of(bake.receivers, v);
            if (set.material != subject.material || range.begin % step != 0) {
                return found;
            }
            const TruthReceiver receiver{set.outside[v - set.first], set.inside[v - set.first], v};
            append_pairs(relight_rows(rows_of(asset, v),
                                      view_of_rows(subject.layout, receiver.inside.normal), lights),
                         eval_truth(truth, receiver, found.rays), found.pairs);
            return found;
        },
        [&](Range, const Found& found) {
            check.pairs.insert(check.pairs.end(), found.pairs.begin(), found.pairs.end());
            check.rays += found.rays;
        });
    return check;
}

}  // namespace

std::vector<EffectCheck> check_rows(const BakeInputs& bake, std::span<const SubjectState> subjects,
                                    const Knobs& knobs, const formats::AssetView& asset,
                                    std::span<const TestLight> lights, const Context& context) {
    const std::vector<std::uint32_t> drawn =
        draw_receivers(count_receivers(bake.receivers), knobs.seed);
    std::vector<EffectCheck> checks;
    for (const SubjectState& subject : subjects) {
        const SubjectTruth truth = make_subject_truth(bake, subject, knobs, {}, lights, context);
        if (!truth.parts.empty()) {
            checks.push_back(check_subject(bake, truth, subject, asset, drawn, lights));
        }
    }
    return checks;
}

}  // namespace opaline::bake
