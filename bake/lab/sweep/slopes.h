#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/lab/sweep/ladders.h"

namespace opaline::bake {

/// One rung of a ladder, with its difference from the ladder's finest rung.
struct Convergence {
    double value = 0;    ///< of the knob
    double error = 0;    ///< relative RMS
    double seconds = 0;  ///< that it took
};

/// error = exp(intercept) * value^slope, or exp(intercept + slope * value) on a semi-logarithmic
/// ladder.
struct Slope {
    double slope = 0, intercept = 0;
    double standard_error = 0;      ///< of the slope; 0 where only two points are left to fit
    std::vector<double> used;       ///< values of the rungs fitted
    std::vector<double> saturated;  ///< values left out: finer, but hardly closer
};

/// Least squares through the logarithms. Left out: errors of 0, and from the fine end the rungs
/// that are less than a tenth closer than their coarser neighbour. Nothing where fewer than two
/// remain. `rungs`: from coarse to fine. `semi_log`: value itself instead of its logarithm.
std::optional<Slope> fit_slope(std::span<const Convergence> rungs, bool semi_log);

/// The theoretical rate at which the error falls with a knob.
struct Theory {
    double rate = 0;        ///< exponent of the value, or of e per step if `semi_log`
    bool semi_log = false;  ///< the error falls by a factor per step of the value
    std::string knob;       ///< "coefficients M"
    std::string words;      ///< what the rate assumes
};

/// Nothing for knobs that are no estimator's step: presets, grids, switches. `g`: mean cosine of
/// the phase function.
std::optional<Theory> convergence_theory(const Ladder& ladder, double g);

}  // namespace opaline::bake
