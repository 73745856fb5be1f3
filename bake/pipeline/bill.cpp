#include "bake/pipeline/bill.h"

namespace opaline::bake {

Bill::Bill(const Rates& rates, unsigned threads, std::vector<PlanEntry>& plan)
    : crowding_(threads > 1 ? rates.crowding : 1), threads_(threads) {
    for (PlanEntry& entry : plan) {
        entry.predicted_seconds = 0;
        entry.predicted_bytes = 0;
    }
}

void Bill::add(const Work& work, PlanEntry* payer) {
    const double seconds = work.alone + work.shared * crowding_ / threads_;
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
