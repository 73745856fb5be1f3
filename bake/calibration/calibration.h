#pragma once

#include "bake/plan/rates.h"

namespace opaline::bake {

/// Measures this machine: runs small pieces of every stage on a dented ball, for about two seconds.
/// CPU time of the threads at work, not what the clock on the wall says: what else the machine does
/// in the meantime counts little. `threads` >= 1: as many as a bake here would use at most.
Rates measure_rates(unsigned threads);

}  // namespace opaline::bake
