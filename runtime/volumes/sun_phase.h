#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/volumes.h"

namespace opaline::runtime {

/// Tables that a sun's light meets in a volume, at most.
inline constexpr std::size_t kMaxSunTerms = 3;

/// What a volume scatters of a sun's light, beside the harmonics of light that was scattered
/// before: per scattering coefficient and unit of irradiance E of the sun at the place
///
///     q(c, V T) = sum_{j < terms} (V T)^(power_j albedo) table_j(c),
///
/// c the cosine between propagation directions, V the share of the sun's light that reaches the
/// place and T that of the place's light that reaches the eye, both as the file counts them: with
/// the forward peak f of the phase function as light that goes on. One term of power 0 is the
/// file's own phase function, cut at its peak.
///
/// Forward peaks of Henyey and Greenstein's functions are narrower than the file's harmonics hold,
/// and light in them is scattered many times. Along a straight line from the sun to the eye with L
/// scatterings its distribution is known [Goudsmit1940]: of moments e^(L (g^k - 1)). What the file
/// shows of it is e^(-L (1 - f)) sum over n of x^n / n! with x = L (g^k - f), k < 5: n = 0 as
/// light that goes on, n = 1 by the phase function, n > 1 by rows. So the moments of (1 - f) q are,
/// per scattering,
///
///     (e^x - e^(-f L)) / L,   for k < 5 less (e^x - 1 - x) / L.
///
/// They are fitted by exponentials of L: as (V T)^albedo = e^(-L (1 - f)), those are products of
/// what is before the place and what is behind it. The fit errs by less than 0.3 % of all scattered
/// light for g = 0.85, ahead by less than 4 % for 0.95.
struct SunPhase {
    std::uint32_t terms = 1;
    std::array<float, kMaxSunTerms> power{};  ///< not below 0; the first one is 0
    std::array<float, kMaxSunTerms> mean{};   ///< of each table over the sphere [1/sr]
    std::vector<float> table;                 ///< kPhaseEntries a term, ball_bank.h [1/sr]
};

/// Where moments and table are those of a Henyey-Greenstein function with a forward peak; of
/// others, and where single scattering has less than 25 terms, `phase` as it is. `phase`: the
/// volume's, kPhaseEntries values.
SunPhase make_sun_phase(const formats::VolumeRecord& record, std::span<const float> phase);

/// Tables of all volumes for shaders: kMaxSunTerms of kPhaseEntries values each, 0 where there are
/// fewer terms; finite, which a damaged file may not be and not all drivers handle.
std::vector<float> pack_sun_tables(const formats::VolumesView& volumes);

/// (share)^(power_j albedo) of each term. Shares outside of [0, 1] count as the nearest.
using SunThrough = std::array<formats::Rgb, kMaxSunTerms>;
SunThrough find_sun_through(const SunPhase& phase, formats::Rgb albedo, formats::Rgb share);

}  // namespace opaline::runtime
