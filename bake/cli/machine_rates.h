#pragma once

#include <string>

#include "bake/base/stage_log.h"
#include "bake/pipeline/cost_model.h"
#include "bake/plan/stage_rates.h"

namespace opaline::cli {

/// The rates of this machine, and their source.
struct MachineRates {
    bake::StageRates rates;
    std::string note;  ///< for the report
};

/// Reads what earlier bakes taught (rates_cache.h); a cache that is not there or damaged teaches
/// nothing.
MachineRates find_machine_rates();

/// Adds what a bake took to `rates`, as they were found, and keeps them in the user's cache.
/// `predicted`: for the knobs that it used. A cache that cannot be written stays as it is.
void learn_machine_rates(bake::StageRates rates, const bake::CostPrediction& predicted,
                         const bake::StageLog& ran);

}  // namespace opaline::cli
