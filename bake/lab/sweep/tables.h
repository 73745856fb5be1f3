#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bake/lab/sweep/analysis.h"

namespace opaline::bake {

/// The knobs that a sweep changes, as in its tables.
nlohmann::ordered_json sweep_knobs_json(const Knobs& knobs);

/// One row a point, in the order in which they were baked; RFC 4180. Columns: label, the ladders it
/// stands on, its knobs, seconds as a whole and by what they went into, bytes, peak memory, error
/// with confidence interval, the same against the finest bake, the ways to compute that it chose,
/// its total error against path tracing, errors by effect and by light, and where it stands to the
/// fronts. Then one row for each rung of the Monte Carlo reference (`reference_samples`): its
/// seconds, and its error against its own truth.
std::string make_sweep_csv(const SweepResult& result, const SweepAnalysis& analysis);

/// The same with scene, plan, presets, fronts, slopes, pairs of pictures and skipped points. Text
/// that is not UTF-8 is still as the user wrote it: dump with the error handler `replace`.
nlohmann::ordered_json make_sweep_json(const SweepResult& result, const SweepAnalysis& analysis);

}  // namespace opaline::bake
