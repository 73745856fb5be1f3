#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bake/effects/multiple/medium_profile.h"

namespace opaline::bake {

/// A profile of this width, in spacings of a blue-noise set, is summed to better than 1 %
/// (multiple/README.md, "Sampling").
inline constexpr double kWidthPerSpacing = 1.2;

/// A medium's profile, prepared for sums over samples `spacing` apart.
///
/// Samples farther apart than the width of the profile sample its peak badly: the sum errs by tens
/// to thousands of per cent. The profile is therefore split in two,
///     R_d(r) = R_far(r) + R_near(r),    R_far(r) = R_d(sqrt(r^2 + b^2)),
/// with b per band such that R_far is as wide as the spacing requires; b = 0 where R_d is wide
/// enough already. On a plane R_far integrates to exactly R_>(b), because r dr = rho d rho. The
/// rest, R - R_>(b), weights the mean of E near the receiver. Energy is conserved for any shape of
/// the surface. The limits are the plain sum (b = 0) and an opaque surface (T_d = R E).
/// multiple/README.md, "Sampling".
struct GatherProfile {
    std::uint32_t bands = 3;        ///< or 1, valid for all three; the other bands are then 0 below
    std::vector<float> table;       ///< [step][band]: R_far at steps of 1 + r^2 / z^2, 64 an octave
    float inverse_z_squared = 1;    ///< [1/m^2]
    std::array<double, 3> total{};  ///< R per band
    std::array<float, 3> near_mass{};  ///< R - R_>(b) per band
    float near_radius = 0;             ///< [m] within which E is averaged; 0: no near part
};

/// `spacing` [m] between samples, `largest_distance` [m]: the table's reach. `bands`: 3, or 1 where
/// the three bands of the medium coincide.
GatherProfile make_gather_profile(const MediumProfile& medium, double spacing,
                                  double largest_distance, std::uint32_t bands = 3);

/// R_far of each band [1/m^2] at squared distance r2 [m^2]; 0 beyond the table and in bands that
/// the profile lacks.
std::array<float, 3> eval_far(const GatherProfile& profile, float r2);

}  // namespace opaline::bake
