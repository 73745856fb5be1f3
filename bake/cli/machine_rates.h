#pragma once

#include <string>

#include "bake/plan/rates.h"

namespace opaline::cli {

/// How fast this machine is, and how that is known.
struct MachineRates {
    bake::Rates rates;
    std::string note;  ///< for the report
};

/// Read from the user's cache (rates_cache.h); where it has none for this machine, measured now,
/// said so on stderr, and kept there. Not being able to keep them is no error: the next command
/// measures again.
MachineRates find_machine_rates();

}  // namespace opaline::cli
