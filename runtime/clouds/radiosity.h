#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/rgb.h"
#include "runtime/clouds/plane_gather.h"

namespace opaline::runtime {

/// A cell of the ground and the cell of the clouds' base above it, per band.
struct RadiosityCell {
    formats::Rgb emission;     ///< S_C: diffuse light that the base sends down [W/m^2], >= 0
    formats::Rgb direct;       ///< S_G^d: direct irradiance on the ground [W/m^2], >= 0
    formats::Rgb albedo;       ///< of the ground, in [0, 1]
    formats::Rgb reflectance;  ///< Rbar of the base, in [0, 1]
};

struct RadiosityOptions {
    float tolerance = 1e-3f;        ///< of what passes left out would add, > 0
    std::uint32_t max_passes = 16;  ///< from ground to base and back
    unsigned threads = 0;           ///< 0: all cores; the result has the same bits for any number
};

struct Radiosity {
    std::vector<formats::Rgb> ground;  ///< RG: indirect irradiance on the ground [W/m^2], by cell
    std::vector<formats::Rgb> base;    ///< RC: irradiance on the base from the ground [W/m^2]
    formats::Rgb outside_ground, outside_base;  ///< the same beyond a grid that does not wrap
    std::uint32_t passes = 0;                   ///< as done
};

/// Passes after which (rho R)^n / (1 - rho R) < tolerance in all bands, max_passes at most; 0
/// where the ground is black. Values in [0, 1].
std::uint32_t count_passes(const formats::Rgb& albedo, const formats::Rgb& reflectance,
                           const RadiosityOptions& options);

/// Light between the ground and the base of clouds, two Lambertian planes [Bouthors2006]. Passes
/// go on as count_passes has it for the largest values of all cells. What is left then is
/// added as a geometric series, in the shape of the last pass and with the quotient of its energy,
/// at most kMaxQuotient: exact for even planes. Beyond a grid that does not wrap everything is as
/// `outside`, and the inside does not reach it. Precondition: one cell per cell of the grid, values
/// finite.
inline constexpr double kMaxQuotient = 0.9999;
Radiosity solve_radiosity(const PlaneGrid& grid, const std::vector<RadiosityCell>& cells,
                          const RadiosityCell& outside, const RadiosityOptions& options = {});

}  // namespace opaline::runtime
