#include "bake/accuracy/sweep/point_order.h"

#include <algorithm>
#include <utility>

namespace opaline::bake {

int urgency(const SweepPoint& point) {
    const auto stands_on = [&](Ladder ladder) {
        return std::any_of(point.rungs.begin(), point.rungs.end(),
                           [&](const Rung& r) { return r.ladder == ladder; });
    };
    const Ladder& first = point.rungs.front().ladder;
    return stands_on(Ladder::preset)                             ? 0
           : first.knob != nullptr && !first.knob->words.empty() ? 1
           : first == Ladder::grid                               ? 3
                                                                 : 2;
}

void order_points(std::vector<SweepPoint>& points,
                  const std::function<double(const SweepPoint&)>& seconds) {
    std::vector<std::pair<double, SweepPoint>> costed;
    for (SweepPoint& point : points) {
        const double cost = seconds(point);
        costed.emplace_back(cost, std::move(point));
    }
    std::ranges::stable_sort(costed, {}, [](const auto& one) {
        return std::pair{urgency(one.second), one.first};
    });
    points.clear();
    for (auto& [cost, point] : costed) {
        points.push_back(std::move(point));
    }
}

}  // namespace opaline::bake
