#pragma once

#include <cstdint>
#include <span>

#include "bake/multiple/medium_profile.h"
#include "bake/single/body.h"
#include "bake/visibility/ray_scene.h"

namespace opaline::bake {

/// How much too bright multiple scattering may be because the dipole takes every surface for that
/// of a half space: what a half space would let out beyond the body's thickness d, R_>(d) / R, in
/// the worst band, averaged over the receivers `drawn` (translucency.md 5, row 27). 0 in thick
/// bodies, 1 in thin sheets lit from both sides. d: the way along the inward normal.
double estimate_thin_excess(const MediumProfile& profile, const RayScene& rays,
                            std::uint32_t material, std::span<const BodyPoint> points,
                            std::span<const std::uint32_t> drawn);

}  // namespace opaline::bake
