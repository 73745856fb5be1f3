#pragma once

#include "bake/plan/effect.h"
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

/// Decides whether light from other surfaces matters to a material's receivers. Under uniform light
/// of radiance 1 no surface is brighter than its albedo, so what others send to a receiver is at
/// most the share o of its hemisphere that they may cover (incident.h), times the largest
/// albedo of the scene, times its own:
///     bound = rho o rho_max.
PlanEntry decide_interreflection(const PlanInput& input);

/// Light that one surface reflects, or that leaves a body, to another surface, any number of times.
EffectDescriptor describe_interreflection(Effect id);

}  // namespace opaline::bake
