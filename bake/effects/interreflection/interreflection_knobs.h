#pragma once

#include <algorithm>
#include <cmath>

#include "bake/plan/bake_plan.h"
#include "bake/plan/knob.h"

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

}  // namespace opaline::bake
