#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bake/pipeline/cost_model.h"
#include "bake/plan/stage_work.h"

namespace opaline::bake {

/// Adds stages up, and what each decision has in them: fills in a plan's predictions.
class Bill {
  public:
    /// `plan` must outlive it; earlier predictions are overwritten. `threads` >= 1.
    Bill(const Rates& rates, unsigned threads, std::vector<PlanEntry>& plan);

    void open(std::string stage) { cost.stages.push_back({std::move(stage), 0}); }
    /// Into the stage that was opened last; `payer`: an entry of the plan that is on, or null for
    /// shared work.
    void add(const Work& work, PlanEntry* payer = nullptr);
    /// Into the file.
    void add_bytes(double bytes, PlanEntry* payer = nullptr);

    CostPrediction cost;

  private:
    double crowding_, threads_;
};

}  // namespace opaline::bake
