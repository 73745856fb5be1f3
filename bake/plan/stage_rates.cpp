#include "bake/plan/stage_rates.h"

#include <cmath>

namespace opaline::bake {

double StageRates::factor(const std::string& kind) const {
    if (const auto known = kinds.find(kind); known != kinds.end()) return known->second.factor;
    double sum = 0;
    for (const auto& [name, learnt] : kinds) {
        sum += std::log(learnt.factor);
    }
    return kinds.empty() ? 1 : std::exp(sum / static_cast<double>(kinds.size()));
}

}  // namespace opaline::bake
