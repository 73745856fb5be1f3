#pragma once

#include "bake/plan/effect.h"
#include "bake/plan/rates.h"

namespace opaline::bake {

/// Measures seconds per unit of work on this machine: runs small pieces of every stage on a dented
/// ball for a few seconds; every effect measures its own rates. Times are CPU times of the working
/// threads, so other processes matter little. `threads` >= 1: the largest number that a bake here
/// would use.
Rates measure_rates(const EffectTable& effects, unsigned threads);

}  // namespace opaline::bake
