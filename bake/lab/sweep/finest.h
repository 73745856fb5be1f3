#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/lab/sweep/run_sweep.h"

namespace opaline::bake {

/// Index of the point to compare others of the same choices with: the one with the smallest
/// self-measured error. It need not be the one intended as finest; with little time a preset may
/// have more texels. Ties go to the slowest. Precondition: there is one of these choices.
std::size_t find_finest(std::span<const PointRecord> points, std::string_view choices);

/// Chooses the finest point of each way to choose, and compares the others with it. The truth is
/// that of the choices that most points made. `lights`: names of those that the probes are relit
/// under.
void compare_with_finest(SweepResult& result, const EffectTable& effects,
                         const formats::Scene& scene, std::span<const std::uint32_t> probes,
                         std::span<const std::string> lights);

}  // namespace opaline::bake
