#include <algorithm>
#include <map>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/measure/truth.h"
#include "bake/pilot/pilot.h"

namespace opaline::bake {
namespace {

// Opaque receivers are cheap to know, and shadows' edges make few of them say little.
constexpr std::size_t kLeastReceivers = 64, kMostReceivers = 1024, kVerticesPerReceiver = 40;
constexpr std::size_t kMostTranslucent = 192;

// The truth need be no finer than what is asked for.
std::uint32_t surface_points(double target) {
    return target >= 0.03 ? 256 : target >= 0.015 ? 512 : 1024;
}
std::uint32_t depth_samples(double target) {
    return target >= 0.03 ? 8 : 16;
}

bool is_simulated(const RowLayout& layout) {
    return layout.translucent ? layout.multiple || layout.single_terms > 0 : layout.direct;
}

// Leaves about kMostTranslucent of a medium's receivers, evenly spread; of the opaque ones as many
// in proportion as without, so that the error of all is that of the scene.
void thin_out(const PilotScene& pilot, std::vector<PilotReceiver>& receivers) {
    const auto translucent = static_cast<std::size_t>(
        std::count_if(receivers.begin(), receivers.end(),
                      [&](const auto& r) { return pilot.layouts[r.material].translucent; }));
    const std::size_t step = (translucent + kMostTranslucent - 1) / kMostTranslucent;
    if (step > 1) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < receivers.size(); i += step) {
            receivers[kept++] = std::move(receivers[i]);
        }
        receivers.resize(kept);
    }
}

}  // namespace

std::vector<PilotReceiver> find_pilot_truth(const PilotScene& pilot, const Knobs& knobs,
                                            std::span<const TestLight> lights,
                                            const Context& context) {
    std::vector<PilotReceiver> receivers;
    const std::size_t wanted =
        std::clamp(pilot.points.size() / kVerticesPerReceiver, kLeastReceivers, kMostReceivers);
    for (const std::uint32_t v :
         draw_evenly(pilot.points.size(), wanted, RandomStage::pilot_receivers, knobs.seed)) {
        if (is_simulated(pilot.layouts[pilot.points[v].material])) {
            receivers.push_back({v, pilot.points[v].material, {}});
        }
    }
    thin_out(pilot, receivers);
    std::optional<DirectTruth> direct;
    std::map<std::uint32_t, TranslucentTruth> translucent;
    for (const PilotReceiver& r : receivers) {
        const RowLayout& layout = pilot.layouts[r.material];
        if (!layout.translucent) {
            direct = direct ? std::move(direct) : make_direct_truth(lights);
        } else if (!translucent.contains(r.material)) {
            const auto profile = pilot.profiles.find(r.material);
            TranslucentTruth truth = make_translucent_truth(
                pilot.scene, r.material,
                profile != pilot.profiles.end() ? &profile->second : nullptr,
                layout.single_terms > 0 ? depth_samples(knobs.error_target) : 0, lights);
            truth.points = surface_points(knobs.error_target);
            translucent.emplace(r.material, std::move(truth));
        }
    }
    std::size_t done = 0;
    for_each_block_in_order(
        receivers.size(), 1, context,
        [&](Range range) {
            const PilotReceiver& r = receivers[range.begin];
            std::uint64_t traced = 0;
            const auto body = translucent.find(r.material);
            return body == translucent.end()
                       ? eval_truth(*direct, pilot.rays, pilot.receivers[r.vertex], lights, traced)
                       : eval_truth(body->second, pilot.scene, pilot.rays, pilot.points[r.vertex],
                                    knobs.seed, r.vertex, traced);
        },
        [&](Range range, TwoEstimates&& truth) {
            receivers[range.begin].truth = std::move(truth);
            done = range.end;
        });
    receivers.resize(done);
    return receivers;
}

}  // namespace opaline::bake
