#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bake/accuracy/sweep/run_sweep.h"

namespace opaline::bake {

/// Index of the point to compare all others with: the one with the smallest self-measured error. It
/// need not be the one intended as finest; with little time a preset may have more texels. Ties go
/// to the slowest. Precondition: there is one.
std::size_t find_finest(std::span<const PointRecord> points);

/// Chooses the truth and compares all points with it.
void compare_with_finest(SweepResult& result, const EffectTable& effects,
                         const formats::Scene& scene, std::span<const std::uint32_t> probes);

}  // namespace opaline::bake
