#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/plan/effect.h"
#include "bake/transport/ray_scene.h"

namespace opaline::bake {

/// How much too bright multiple scattering may be because the dipole takes every surface for that
/// of a half space: what a half space would let out beyond the body's thickness d, R_>(d) / R, in
/// the worst band, averaged over the points (translucency.md 5, row 27). 0 in thick bodies, 1 in
/// thin sheets lit from both sides. d: the way along the inward normal.
double estimate_thin_excess(const MediumProfile& profile, const RayScene& rays,
                            std::span<const BodyPoint> points);

/// Says where the dipole's half space is far from the truth.
void warn_of_thin_parts(const EffectInputs& inputs, const MediumProfile& profile,
                        std::vector<formats::Diagnostic>& warnings);

}  // namespace opaline::bake
