#include "bake/pipeline/bill.h"

#include <utility>

namespace opaline::bake {

Bill::Bill(const StageRates& rates, unsigned threads, std::vector<PlanEntry>& plan)
    : rates_(rates), threads_(threads) {
    for (PlanEntry& entry : plan) {
        entry.predicted_seconds = 0;
        entry.predicted_bytes = 0;
    }
}

void Bill::open(std::string stage, std::string kind) {
    kind = kind.empty() ? stage : std::move(kind);
    factor_ = rates_.factor(kind);
    cost.stages.push_back({std::move(stage), std::move(kind), 0, 0});
}

void Bill::add(const Work& work, PlanEntry* payer) {
    const double seconds = factor_ * (work.alone + work.shared / threads_);
    cost.stages.back().work += work.alone + work.shared;
    cost.stages.back().seconds += seconds;
    cost.seconds += seconds;
    (payer != nullptr ? payer->predicted_seconds : cost.shared_seconds) += seconds;
}

void Bill::add_bytes(double bytes, PlanEntry* payer) {
    const auto whole = static_cast<std::uint64_t>(bytes);
    cost.bytes += whole;
    (payer != nullptr ? payer->predicted_bytes : cost.shared_bytes) += whole;
}

}  // namespace opaline::bake
