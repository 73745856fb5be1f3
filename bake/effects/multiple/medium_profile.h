#pragma once

#include <array>
#include <cstdint>

#include "bake/base/context.h"
#include "bake/scattering/profile.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The diffuse reflectance profile of a medium in three bands.
struct MediumProfile {
    std::array<Profile, 3> band;
    std::array<double, 3> scale{1, 1, 1};  ///< multiplies each: `energy_match`
    double exit = 1;      ///< c_exit = 1 - F_ext (scattering/README.md, "Exit"), 1 in `paper` mode
    double smallest = 0;  ///< profile_length of the densest band [m]; 0: nothing scatters
    double eta = 1;

    /// R_d [1/m^2], total reflectance R, and the part of R beyond distance `a` [m].
    double eval(std::size_t b, double r) const { return scale[b] * eval_profile(band[b], r); }
    double total(std::size_t b) const { return scale[b] * profile_total(band[b]); }
    double tail(std::size_t b, double a) const { return scale[b] * profile_tail(band[b], a); }
};

/// In physical fidelity, the profiles `automatic`, `better` and `beams` are scaled per band, so
/// that a half space returns the multiple scattering of a random walk (scattering/README.md,
/// "Energy match"). `normalized` gets the walk's whole reflectance, single scattering included.
/// `classic` is not scaled. `paper` fidelity: the classic dipole as printed, whatever `profile`.
MediumProfile make_medium_profile(const formats::Medium& medium, std::uint64_t seed,
                                  const Context& context);

/// Times samples per path: resolves the shape of a body that light crosses.
inline constexpr double kLeastSamplesPerPath = 2000;

/// Number of samples on the surface of a medium: `per_path` per squared depth of its source. At
/// `per_path` = 1 their sum errs by about 1 % (multiple/README.md, "Sampling"). At least 2000
/// `per_path`, at most `most`. `area` [m^2].
std::uint32_t count_samples(double area, const MediumProfile& profile, double per_path,
                            std::uint32_t most);

}  // namespace opaline::bake
