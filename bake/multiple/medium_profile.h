#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/scattering/dipole.h"
#include "formats/scene.h"

namespace opaline::bake {

using Rgb3 = std::array<double, 3>;

/// The diffuse reflectance profile of a medium in three bands, tabulated for the gather.
struct MediumProfile {
    std::array<Dipole, 3> dipole;
    Rgb3 scale{1, 1, 1};    ///< multiplies each dipole: `energy_match`
    double exit = 1;        ///< c_exit = 1 - F_ext (translucency.md 3.1), 1 in `paper` mode
    double smallest_z = 0;  ///< depth of the source of the densest band [m]
    double eta = 1;
    std::vector<std::array<float, 3>> table;  ///< scale R_d over log2(1 + r^2 / z^2), evenly spaced
    double steps_per_octave = 1, inverse_z_squared = 1;

    double total(std::size_t band) const { return scale[band] * dipole_total(dipole[band]); }
    double tail(std::size_t band, double a) const {
        return scale[band] * dipole_tail(dipole[band], a);
    }
};

/// `largest_distance` [m]: the table's reach. Profiles `automatic` and `better` give the better
/// dipole, in physical fidelity scaled per band so that a half space returns what a random walk of
/// it returns beyond single scattering (translucency.md 3.4, energy_match); `classic` the classic
/// dipole unscaled; `paper` fidelity the classic dipole as printed.
/// Precondition: profile is none of `beams`, `normalized`.
MediumProfile make_medium_profile(const formats::Medium& medium, double largest_distance,
                                  std::uint64_t seed, const Context& context);

/// scale R_d(r) of the three bands [1/m^2] at squared distance r2 [m^2]; 0 beyond the table.
std::array<float, 3> eval_profile(const MediumProfile& profile, float r2);

}  // namespace opaline::bake
