#pragma once

#include <optional>
#include <vector>

#include "bake/accuracy/sweep/front.h"
#include "bake/accuracy/sweep/run_sweep.h"
#include "bake/accuracy/sweep/slopes.h"

namespace opaline::bake {

/// Where a point stands among all: on the front, and its cost over that of the cheapest point with
/// no larger error.
struct Standing {
    bool on_front_time = false, on_front_bytes = false;
    double times_front_time = 1, times_front_bytes = 1;
};

/// How one knob converges. Each rung against the ladder's finest, all other knobs being equal: what
/// errs for other reasons errs in both.
struct LadderFit {
    Ladder ladder;
    Theory theory;
    std::string against;             ///< label of the finest rung
    std::vector<Convergence> rungs;  ///< from coarse to fine, without the finest
    std::optional<Slope> fit;        ///< nothing where fewer than two rungs can be fitted
};

/// What the front says of one error: the answer in a sentence.
struct Answer {
    double error = 0;  ///< 1 %, or the nearest of 1, 2, 5 times a power of ten that is reached
    double seconds = 0, bytes = 0;
    double halving = 0;  ///< seconds at half the error over seconds at it; 0: not reached
};

struct SweepAnalysis {
    std::optional<Answer> answer;
    std::vector<Standing> standing;  ///< of each point
    std::vector<LadderFit> fits;
    /// Indices of points; nothing where no two differ enough.
    std::optional<CostPair> equal_time, equal_error;
    /// Points the interval of whose own error meets that against the finest bake, and all but that.
    std::size_t checks_agreeing = 0, checks = 0;
};

SweepAnalysis analyse_sweep(const SweepResult& result);

}  // namespace opaline::bake
