#pragma once

#include <cstdint>
#include <span>

#include "bake/exchange/lamp_bounces.h"
#include "bake/plan/dense_rows.h"
#include "bake/plan/effect.h"

namespace opaline::bake {

/// Adds the radiance [nit] that views see of lamps and of what these light, times their weights and
/// factors: of lamp e to column e of each band of the row of each factor. It is the radiance of
/// surfaces and volumes that glow, and exitance over pi of the others, the same in all directions;
/// metals and media pass a view on. `solid_angle` [sr] of each view: textures are means over it.
/// `key`: of the random numbers. Any thread; returns the rays traced.
std::uint64_t add_seen_lamps(const LampBounces& light, std::span<const SurfaceView> views,
                             double solid_angle, std::uint64_t key, const DenseRow& row);

}  // namespace opaline::bake
