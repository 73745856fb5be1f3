#include "bake/calibration/learn_rates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace opaline::bake {

void learn_rates(std::span<const StageCost> predicted, const StageLog& ran, StageRates& rates) {
    constexpr double kLeastSeconds = 5e-3, kFullSeconds = 0.1, kMostFactor = 20,
                     kLeastWeight = 1.0 / 8;
    struct Sum {
        double work = 0, seconds = 0;
    };
    std::map<std::string, Sum> sums;
    std::vector<StageCost> left(predicted.rbegin(), predicted.rend());
    for (auto stage = ran.rbegin(); stage != ran.rend(); ++stage) {
        const auto found = std::ranges::find(left, stage->name, &StageCost::name);
        if (found != left.end()) {
            Sum& sum = sums[found->kind];
            sum.work += found->work;
            sum.seconds += stage->cpu_seconds;
            left.erase(found);
        }
    }
    for (const auto& [kind, sum] : sums) {
        const double factor = sum.seconds / sum.work;
        if (sum.seconds < kLeastSeconds || !(factor > 1 / kMostFactor && factor < kMostFactor)) {
            continue;
        }
        StageRates::Learnt& learnt = rates.kinds[kind];
        ++learnt.bakes;
        const double weight =
            std::max(1.0 / learnt.bakes, kLeastWeight) * std::min(1.0, sum.seconds / kFullSeconds);
        learnt.factor = std::pow(learnt.factor, 1 - weight) * std::pow(factor, weight);
    }
}

}  // namespace opaline::bake
