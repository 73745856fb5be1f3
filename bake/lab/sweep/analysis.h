#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/lab/sweep/ladders.h"
#include "bake/lab/sweep/run_sweep.h"

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

/// Cost of a setting (seconds or bytes, > 0) and its relative error (>= 0).
struct CostPoint {
    double cost = 0, error = 0;
};

/// The Pareto front: true for points that no other dominates in cost and error. Equal points are
/// all on the front.
std::vector<bool> pareto_front(std::span<const CostPoint> points);

/// A point's cost over that of the cheapest point whose error is no larger: 1 on the front, else
/// above. Precondition: index < points.size().
double times_the_front(std::span<const CostPoint> points, std::size_t index);

/// Cost at which the front reaches an error: interpolated in log-log between the two neighbours on
/// the front; negative where the front does not reach that far on both sides.
double front_cost_at(std::span<const CostPoint> points, double error);

/// Two points to show side by side, as indices: `better` lies on the front.
struct CostPair {
    std::size_t better = 0, other = 0;
};

/// Of about the same cost (within 25 %) the two whose errors differ most; of about the same error
/// (within 15 %) the two whose costs differ most. Errors from .2 % to 50 %, where a picture shows
/// something. Nothing where no two differ by a fifth.
std::optional<CostPair> equal_cost_pair(std::span<const CostPoint> points);
std::optional<CostPair> equal_error_pair(std::span<const CostPoint> points);

/// A point's relation to the front of the points of its choices: whether it is on it, and its cost
/// relative to the cheapest point with no larger error.
struct Standing {
    bool on_front_time = false, on_front_bytes = false;
    double times_front_time = 1, times_front_bytes = 1;
    bool on_front_total = false;  ///< of total error against time
};

/// Cost of one combination of choices: time against total error of the points with it.
struct ChoiceLine {
    std::string choices;             ///< PointRecord::choices
    std::vector<std::size_t> front;  ///< indices of points, by rising seconds and falling error
};

/// Convergence of one knob. Each rung is compared with the ladder's finest at equal other knobs, so
/// that other errors cancel.
struct LadderFit {
    Ladder ladder;
    Theory theory;
    std::string against;             ///< label of the finest rung
    std::vector<Convergence> rungs;  ///< from coarse to fine, without the finest
    std::optional<Slope> fit;        ///< nothing where fewer than two rungs can be fitted
};

/// Time and bytes that the front needs for one error: the summary sentence.
struct Answer {
    double error = 0;  ///< 1 %, or the nearest of 1, 2, 5 times a power of ten that is reached
    double seconds = 0, bytes = 0;
    double halving = 0;  ///< seconds at half the error over seconds at it; 0: not reached
};

struct SweepAnalysis {
    std::optional<Answer> answer;    ///< of the truth's choices
    std::vector<ChoiceLine> lines;   ///< in the order in which they were first made
    std::vector<Standing> standing;  ///< of each point
    std::vector<LadderFit> fits;
    /// Indices of points of the truth's choices; nothing where no two differ enough.
    std::optional<CostPair> equal_time, equal_error;
    /// Number of points whose error interval overlaps the one against the finest bake of their
    /// choices, and the number of points compared.
    std::size_t checks_agreeing = 0, checks = 0;
};

SweepAnalysis analyse_sweep(const SweepResult& result);

}  // namespace opaline::bake
