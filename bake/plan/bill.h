#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bake/plan/cost_model.h"
#include "bake/plan/stage_costs.h"

namespace opaline::bake {

/// Adds stages up, and what each effect has in them: fills in a plan's predictions.
class Bill {
  public:
    /// `plan` must outlive it; what was predicted before is forgotten. `threads` >= 1.
    Bill(const Rates& rates, unsigned threads, std::vector<PlanEntry>& plan);

    void open(std::string stage) { cost.stages.push_back({std::move(stage), 0}); }
    /// Into the stage that was opened last; for an effect on a material, or for none. What is not
    /// on pays for nothing.
    void add(const Work& work, std::string_view effect = {}, std::uint32_t material = 0);
    /// Into the file.
    void add_bytes(double bytes, std::string_view effect = {}, std::uint32_t material = 0);

    CostPrediction cost;

  private:
    PlanEntry* find(std::string_view effect, std::uint32_t material);

    double crowding_, threads_;
    std::vector<PlanEntry>& plan_;
};

}  // namespace opaline::bake
