#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// A texture that the material's own light is multiplied by.
bool has_textures(const PlanInput& input);

/// Decides whether what others see of a material is filtered over the cells of scatterers, or
/// looked up at points. Under uniform light of radiance 1 a scatterer's light changes by at most
/// the contrast c of the textures, that of base colour times brightest albedo and of gloss, and so
/// changes that of a receiver by at most
///     bound = rho_max c,
/// rho_max the largest albedo of the scene. The bound is 0 where the textures are the same
/// everywhere, where nothing rises above the surface's horizon, so that nothing sees it, and where
/// a texel is wider than four cells of mean area: filtering over less than a texel is looking up
/// the point (sample_footprint).
PlanEntry decide_textures(const PlanInput& input);

}  // namespace opaline::bake
