#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/opal/clouds.h"
#include "formats/opal/rgb.h"

namespace opaline::runtime {

/// Between two nodes of an even axis: the first one and the share of the second.
struct TablePlace {
    std::size_t first = 0;
    float share = 0;
};
/// `fraction` in [0, 1] of an axis of `count` >= 2 nodes; clamped to it, NaN is 0.
TablePlace place_on_axis(float fraction, std::size_t count);
/// Even in depth / (1 + depth); depth in [0, inf].
TablePlace place_depth(float depth, std::size_t count);

/// The coordinate u of LayerTables::log_phase at an angle of [0, pi] [rad].
float phase_coordinate(float angle);

/// Mean square angle of one scattering by the peak [rad^2]; 0 where there is no peak.
float peak_mean_square(const formats::LayerTables& tables, const formats::LayerRecord& record);

/// P_S [1/sr] at a scattering angle [rad], as it looks after `events` scatterings by the peak on
/// average: those turn light too, and blur the edge at the peak's angle. P_S alone ends there, and
/// is 0 within; light that the peak scattered besides looks it through a Gaussian of events / 2
/// `mean_square` per axis. `coordinate` as above, of max(angle, peak_angle).
float rest_phase(const formats::LayerTables& tables, const formats::LayerRecord& record,
                 std::size_t band, float angle, float coordinate, float events, float mean_square);

/// What the peak scatters once or more, per unit of incoming light [1/sr], after `events`
/// scatterings on average, >= 0. 0 where there is no peak.
float forward_glow(const formats::LayerTables& tables, const formats::LayerRecord& record,
                   float angle, float events);

/// What becomes of a beam's flux: all shares together are 1. By reciprocity also what an eye sees
/// at the cosine of the view under even light of radiance 1, straight: of what lies behind.
struct FluxShares {
    float straight = 1;   ///< T_0
    float once = 0;       ///< T_1, of what is scattered across
    float across = 0;     ///< T_ms - T_0
    float reflected = 0;  ///< 1 - T_ms
};
/// `depth` in [0, inf], kappa_S H; `cosine` in [1e-3, 1]. Shares are in [0, 1] whatever the table
/// holds.
FluxShares flux_shares(const formats::LayerTables& tables, const formats::LayerRecord& record,
                       float depth, float cosine);

/// T of even light over the hemisphere, in [0, 1].
float mean_transmittance(const formats::LayerTables& tables, float depth);

/// The tables of light scattered twice or more, for one cosine of the light: a value is mode m of
/// the factor in formats/opal/clouds.h, [((side * modes + m) * depths + depth) * cosines + view],
/// sides reflected, then transmitted. Ready for a texture array of 2 modes layers, cosines x depths
/// texels. Without modes where the file leaves that light out.
struct SunTable {
    std::size_t modes = 0, depths = 0, cosines = 0;
    std::vector<formats::Rgb> value;
};
/// `cosine` of the light in [1e-3, 1]; the tables of the three bands.
SunTable make_sun_table(const std::array<formats::LayerTables, 3>& tables,
                        const formats::LayerRecord& record, float cosine);

/// Radiance of light scattered twice or more, per irradiance facing the sun [1/sr], over 1 -
/// exp(-X_v): `depth` by band; cosines in [1e-3, 1]; `cos_azimuth` of the angle between the
/// horizontal directions that light and view travel in. Not below 0.
formats::Rgb multiple_source(const SunTable& table, const std::array<float, 3>& depth, float light,
                             float view, float cos_azimuth, bool transmitted);

}  // namespace opaline::runtime
