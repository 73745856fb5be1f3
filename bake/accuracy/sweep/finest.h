#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bake/accuracy/sweep/run_sweep.h"

namespace opaline::bake {

/// Index of the point that all others are compared with: the one that found the least wrong with
/// itself, against truths that no knob changes. What was meant to be the finest need not be it: on
/// little time a preset may have more texels. Of equals the one that took longest.
/// Precondition: there is one.
std::size_t find_finest(std::span<const PointRecord> points);

/// Chooses the truth and compares all points with it.
void compare_with_finest(SweepResult& result, const EffectTable& effects,
                         const formats::Scene& scene, std::span<const std::uint32_t> probes);

}  // namespace opaline::bake
