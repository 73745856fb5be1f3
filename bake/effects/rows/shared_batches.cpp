#include "bake/effects/rows/shared_batches.h"

#include <algorithm>
#include <utility>

namespace opaline::bake {
namespace {

// Receivers that a batch of `bytes` may hold; 0: the subject has no batches.
std::size_t most_receivers(std::span<const Gatherer> gatherers, std::size_t bytes) {
    std::size_t most = 0;
    for (const Gatherer& g : gatherers) {
        if (g.effect->gather.batch_size == nullptr) continue;
        const std::size_t own = g.effect->gather.batch_size(*g.inputs.own.prepared, bytes);
        most = most == 0 ? own : std::min(most, own);
    }
    return most;
}

}  // namespace

SharedBatches::SharedBatches(const BakeInputs& bake, std::span<const SubjectState> subjects,
                             const Knobs& knobs, const Context& context, std::size_t bytes)
    : bake_(bake), subjects_(subjects), knobs_(knobs), context_(context), bytes_(bytes) {
    const auto has_batches = [&](const SubjectState& subject) {
        return most_receivers(make_gatherers(bake, subject, knobs, context), bytes) > 0;
    };
    const auto sharing = std::ranges::count_if(subjects, has_batches);
    bytes_ /= static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, sharing));
}

void SharedBatches::fill(Batch& batch, std::size_t set, std::uint64_t& rays) {
    const std::uint32_t material = bake_.receivers[set].material;
    batch.gatherers = make_gatherers(bake_, state_of(subjects_, material), knobs_, context_);
    const std::size_t most = most_receivers(batch.gatherers, bytes_);
    std::vector<BodyPoint> points;
    for (std::size_t i = set; i < bake_.receivers.size(); ++i) {
        const ReceiverSet& own = bake_.receivers[i];
        if (own.material != material || own.size() == 0) continue;
        if (points.size() + own.size() > most) break;
        batch.place[i] = points.size();
        points.insert(points.end(), own.inside.begin(), own.inside.end());
    }
    if (batch.place.size() < 2) {
        batch = {};
    } else {
        rays += gather_batches(batch.gatherers, points);
    }
}

SharedBatches::Found SharedBatches::find(std::size_t set, std::uint64_t& rays) {
    finished_.clear();
    const std::uint32_t material = bake_.receivers[set].material;
    Batch& batch = batches_[material];
    if (!batch.place.contains(set)) {
        batch = {};
        fill(batch, set, rays);
        if (batch.place.empty()) return {};
    }
    const std::size_t place = batch.place[set];
    batch.place.erase(set);
    if (!batch.place.empty()) return {&batch.gatherers, place};
    // Its last set: the batch goes with the next call.
    return {&(finished_[material] = std::exchange(batch, {})).gatherers, place};
}

}  // namespace opaline::bake
