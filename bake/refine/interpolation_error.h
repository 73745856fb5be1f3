#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/refine/proxy_rows.h"

namespace opaline::bake {

/// Squares by kind of light: distant light, then lamps.
using ErrorColumns = std::array<double, 1 + ProxyTracer::kMostLamps>;

/// A corner's part in what a triangle interpolates.
struct MixedRow {
    std::uint32_t row;
    float weight;
};

/// The square of what proxy `row` is beyond the sum of others; of the row itself without any.
/// Distant light: the mean square over suns of all directions and the square under an even sky,
/// half each, in units in which both are 1 of an open receiver; of walls summed over both sides.
/// Lamps: [lx^2]. Products of the two
/// estimates of a row, so that noise has a mean of 0, and single values may be negative.
/// `solid_angle`: of the cells of a face [sr] (formats::texel_solid_angles).
ErrorColumns square_beyond(const ProxyRows& rows, std::span<const double> solid_angle,
                           std::uint32_t row, std::span<const MixedRow> others);

/// The square of a row, as square_beyond of no others has it, of which distant light counts as far
/// as something shades it: a side that lacks the share h of an even sky's light counts by h / .003,
/// at most 1. So what flat open ground there is around a scene does not change what it errs by.
ErrorColumns square_where_shaded(const ProxyRows& rows, std::span<const double> solid_angle,
                                 std::uint32_t row);

}  // namespace opaline::bake
