#pragma once

#include <algorithm>
#include <cmath>

namespace opaline::bake {

/// How far a random number moves: a step is a full length, the number lies within half of it on
/// either side. Steps are in (0, 1], the domain.

/// Of the two numbers of an event that is sampled `samples` >= 1 times: samples^(-1/2). Of one that
/// is stratified by itself: 1 over its strata.
inline double event_step(double samples) {
    return std::min(1.0, 1 / std::sqrt(samples));
}

/// Of every number of a path: (samples survival)^(-1 / variables). `survival`: product of the
/// probabilities by which the path survived and made discrete choices; `variables`: its continuous
/// random numbers so far; none: 1.
inline double global_step(double samples, int variables, double survival) {
    return variables > 0 ? std::min(1.0, std::pow(samples * survival, -1.0 / variables)) : 1.0;
}

/// Shortened so that the contribution changes by at most e^(+-limit / 2) within it.
inline double limited_step(double step, double dln_contribution, double limit) {
    const double change = std::abs(dln_contribution);
    return change * step > limit ? limit / change : step;
}

}  // namespace opaline::bake
