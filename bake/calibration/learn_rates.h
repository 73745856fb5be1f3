#pragma once

#include <span>

#include "bake/base/stage_log.h"
#include "bake/pipeline/cost_model.h"
#include "bake/plan/stage_rates.h"

namespace opaline::bake {

/// Moves the rates of each kind of stage toward what a bake took: log factor' = (1 - w) log factor
/// + w log (cpu_seconds / work), of all stages of the kind together, with w = max(1 / bakes, 1/8),
/// less in proportion below 0.1 s, where a stage's beginning is most of it. Stages are matched by
/// name, the last of each first: a pilot's last round has the knobs of the file, for which
/// `predicted` is. What took less than 5 ms says nothing, nor what took 20 times longer or shorter
/// than the constants say: its cause is not the machine, as where test lights are computed or read.
void learn_rates(std::span<const StageCost> predicted, const StageLog& ran, StageRates& rates);

}  // namespace opaline::bake
