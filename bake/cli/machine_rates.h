#pragma once

#include <string>

#include "bake/plan/rates.h"

namespace opaline::cli {

/// The rates of this machine, and their source.
struct MachineRates {
    bake::Rates rates;
    std::string note;  ///< for the report
};

/// Reads the rates from the user's cache (rates_cache.h). If it has none for this machine, measures
/// them, reports that on stderr and stores them. A failure to store is no error: the next command
/// measures again.
MachineRates find_machine_rates();

}  // namespace opaline::cli
