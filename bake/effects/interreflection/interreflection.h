#pragma once

#include <algorithm>
#include <cmath>

#include "bake/plan/bake_plan.h"
#include "bake/plan/effect.h"
#include "bake/plan/knob.h"
#include "bake/plan/plan_input.h"

namespace opaline::bake {

namespace bounce_knobs {
inline bool bounces(const RowLayout&, std::span<const PlanEntry> decisions) {
    return is_on(decisions, "interreflection");
}
/// Half of the error may come from bounced light: 1.25 % at 256 rays in a box, and less by the
/// power 0.8 of more (RESULTS.md, "Interreflection").
inline double rays_for_error(double error) {
    return std::clamp(256 * std::pow(0.025 / error, 1.25), 16.0, 4096.0);
}
}  // namespace bounce_knobs

/// Rays from a receiver to the surfaces that send light to it, where it is not known from sites.
inline constexpr KnobSpec kBounceRays{
    .name = "bounce_rays",
    .option = "--bounce-rays",
    .placeholder = "N",
    .help =
        "rays from a receiver to other surfaces that reflect light to it, where points around say "
        "too little; default as the quality says",
    .lowest = 16,
    .highest = 65536,
    .preset = {64, 144, 400, 1024},
    .for_target = bounce_knobs::rays_for_error,
    .label = "%g rays to other surfaces",
    .ladder = {16, 64, 144, 256, 400, 1024},
    .theory = {.label = "rays to other surfaces",
               .words = "independent rays; stratified ones do better",
               .rate = -0.5},
    .matters = bounce_knobs::bounces};

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
