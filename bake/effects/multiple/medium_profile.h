#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/physics/profile.h"
#include "bake/plan/effect.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The diffuse reflectance profile of a medium in three bands.
struct MediumProfile {
    std::array<Profile, 3> band;
    std::array<double, 3> scale{1, 1, 1};  ///< multiplies each: `energy_match`
    /// Times R_d for light of other surfaces, which effects for light of the sky that scatters once
    /// do not have: all that a half space returns over what it returns of light scattered more
    /// often.
    std::array<double, 3> all_orders{1, 1, 1};
    double exit = 1;      ///< c_exit = 1 - F_ext (physics/README.md, "Exit"), 1 in `paper` mode
    double smallest = 0;  ///< profile_length of the densest band [m]; 0: nothing scatters
    double eta = 1;

    /// R_d [1/m^2], total reflectance R, and the part of R beyond distance `a` [m].
    double eval(std::size_t b, double r) const { return scale[b] * eval_profile(band[b], r); }
    double total(std::size_t b) const { return scale[b] * profile_total(band[b]); }
    double tail(std::size_t b, double a) const { return scale[b] * profile_tail(band[b], a); }
};

/// In physical fidelity, the profiles `automatic`, `better` and `beams` are scaled per band, so
/// that a half space returns the multiple scattering that it has (half_space_reflectance).
/// `normalized` gets the whole reflectance, single scattering included.
/// `classic` is not scaled. `paper` fidelity: the classic dipole as printed, whatever `profile`.
MediumProfile make_medium_profile(const formats::Medium& medium);

/// How many samples a surface may have.
struct SampleBudget {
    double per_path = 1;   ///< samples per squared depth of the medium's source
    double most = 0;       ///< in all
    double receivers = 0;  ///< that read them
};

/// Number of samples on the surface of a medium, `area` [m^2]. At `per_path` = 1 for each squared
/// `depth` [m] of its source their sum errs by about 1 % (multiple/README.md, "Sampling"); 0: it
/// scatters nothing. Light that receivers are too far apart to show needs no more than some for
/// each of them, but enough for the shape of the body.
std::uint32_t count_samples(double area, double depth, const SampleBudget& budget);

/// A relative RMS error, measured before a bake at some receivers under white and three suns that
/// see each body from different sides. Both sides are Monte Carlo, each estimated twice, so that
/// noise does not count.
struct ModelError {
    double error = 0;
    std::uint32_t receivers = 0;  ///< 0: nothing was measured, as where walks carry no light
};

/// Of multiple scattering by the dipole against random walks. `traced` adds up.
ModelError measure_models(const EffectInputs& inputs, const MediumProfile& profile,
                          std::uint64_t& traced);

/// What one row for all views leaves of light of all orders: of walks from 16 vertices along the
/// views from which rows follow (ViewSet). A quarter of the weight is on the normal, as in the
/// self-check. Errors below 3 % drown in noise and are 0. `traced` adds up.
ModelError measure_views(const EffectInputs& inputs, const MediumProfile& profile,
                         std::uint64_t& traced);

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
