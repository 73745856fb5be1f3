#include <algorithm>
#include <map>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/check/pilot/pilot.h"
#include "bake/check/subject_truth.h"
#include "bake/lights/draw_receivers.h"
#include "bake/receivers/used_vertices.h"

namespace opaline::bake {
namespace {

// Leaves about kMostExpensivePilotReceivers of the receivers whose truth is expensive, evenly
// spread; of the others as many in proportion as without, so that the error of all is that of the
// scene.
void thin_out(const PilotScene& pilot, std::vector<PilotReceiver>& receivers) {
    const auto expensive = static_cast<std::size_t>(
        std::count_if(receivers.begin(), receivers.end(), [&](const auto& r) {
            return has_expensive_truth(pilot.bake, state_of(pilot.subjects, r.material));
        }));
    const std::size_t step =
        (expensive + kMostExpensivePilotReceivers - 1) / kMostExpensivePilotReceivers;
    if (step > 1) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < receivers.size(); i += step) {
            receivers[kept++] = std::move(receivers[i]);
        }
        receivers.resize(kept);
    }
}

}  // namespace

std::vector<PilotReceiver> find_pilot_truth(const PilotScene& pilot, const Knobs& knobs) {
    const auto& sets = pilot.bake.receivers;
    const std::vector<std::uint32_t> used =
        find_used_vertices(pilot.bake.scene, pilot.bake.facts.slots.view());
    const std::size_t wanted = std::clamp(used.size() / kReceiversPerPilotReceiver,
                                          kLeastPilotReceivers, kMostPilotReceivers);
    std::vector<PilotReceiver> receivers;
    std::map<std::uint32_t, SubjectTruth> truths;
    for (const std::uint32_t d :
         draw_evenly(used.size(), wanted, RandomStage::pilot_receivers, knobs.seed)) {
        const std::uint32_t r = used[d];
        const std::uint32_t material = set_of(sets, r).material;
        if (has_truth(pilot.bake, state_of(pilot.subjects, material))) {
            receivers.push_back({r, material, {}});
        }
    }
    thin_out(pilot, receivers);
    for (const PilotReceiver& r : receivers) {
        if (!truths.contains(r.material)) {
            truths.emplace(
                r.material,
                make_subject_truth(pilot.bake, state_of(pilot.subjects, r.material), knobs,
                                   {knobs.numerical_target()}, pilot.lights, pilot.context));
        }
    }
    std::size_t done = 0;
    for_each_block_in_order(
        receivers.size(), 1, pilot.context,
        [&](Range range) {
            const PilotReceiver& r = receivers[range.begin];
            const ReceiverSet& set = set_of(sets, r.receiver);
            const std::size_t i = r.receiver - set.first;
            std::uint64_t traced = 0;
            return eval_truth(truths.at(r.material), {set.outside[i], set.inside[i], r.receiver},
                              traced);
        },
        [&](Range range, TwoEstimates&& truth) {
            receivers[range.begin].truth = std::move(truth);
            done = range.end;
        });
    receivers.resize(done);
    return receivers;
}

}  // namespace opaline::bake
