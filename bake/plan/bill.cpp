#include "bake/plan/bill.h"

namespace opaline::bake {

Bill::Bill(const Rates& rates, unsigned threads, std::vector<PlanEntry>& plan)
    : crowding_(threads > 1 ? rates.crowding : 1), threads_(threads), plan_(plan) {
    for (PlanEntry& entry : plan) {
        entry.predicted_seconds = 0;
        entry.predicted_bytes = 0;
    }
}

void Bill::add(const Work& work, std::string_view effect, std::uint32_t material) {
    const double seconds = work.alone + work.shared * crowding_ / threads_;
    cost.stages.back().seconds += seconds;
    cost.seconds += seconds;
    if (PlanEntry* const entry = find(effect, material)) {
        entry->predicted_seconds += seconds;
    } else {
        cost.shared_seconds += seconds;
    }
}

void Bill::add_bytes(double bytes, std::string_view effect, std::uint32_t material) {
    const auto whole = static_cast<std::uint64_t>(bytes);
    cost.bytes += whole;
    if (PlanEntry* const entry = find(effect, material)) {
        entry->predicted_bytes += whole;
    } else {
        cost.shared_bytes += whole;
    }
}

PlanEntry* Bill::find(std::string_view effect, std::uint32_t material) {
    for (PlanEntry& entry : plan_) {
        if (entry.on && entry.effect == effect && entry.material == material) {
            return &entry;
        }
    }
    return nullptr;
}

}  // namespace opaline::bake
