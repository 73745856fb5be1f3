#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/pipeline/cost_model.h"
#include "bake/plan/stage_work.h"

namespace opaline::bake {

/// Adds stages up, and what each decision has in them: fills in a plan's predictions.
class Bill {
  public:
    /// `rates` and `plan` must outlive it; what was predicted before is forgotten. `threads` >= 1.
    Bill(const StageRates& rates, unsigned threads, std::vector<PlanEntry>& plan);

    /// `kind`: StageCost::kind; empty: the stage's name.
    void open(std::string stage, std::string kind = {});
    /// Into the stage that was opened last; `payer`: an entry of the plan that is on, or null for
    /// shared work.
    void add(const Work& work, PlanEntry* payer = nullptr);
    /// Into the file.
    void add_bytes(double bytes, PlanEntry* payer = nullptr);

    CostPrediction cost;

  private:
    const StageRates& rates_;
    double threads_;
    double factor_ = 1;  // of the stage that was opened last
};

}  // namespace opaline::bake
