#pragma once

#include <span>

#include "bake/plan/bake_plan.h"
#include "bake/plan/knob.h"
#include "bake/plan/knobs.h"

namespace opaline::bake {

namespace emitter_knobs {
inline bool is_lit(const RowLayout&, std::span<const PlanEntry> decisions) {
    return is_on(decisions, Subject::Kind::emitter);
}
inline double particles_for(double error) {
    return error >= 0.1 ? 20000 : error >= 0.04 ? 100000 : error >= 0.015 ? 400000 : 1600000;
}
inline double rays_for(double error) {
    return error >= 0.1 ? 64 : error >= 0.04 ? 256 : error >= 0.015 ? 1024 : 4096;
}
}  // namespace emitter_knobs

/// Particles of each emitter.
inline constexpr KnobSpec kEmitterParticles{
    .name = "emitter_particles",
    .option = "--emitter-particles",
    .placeholder = "N",
    .help =
        "particles of each emitter, for light that surfaces reflect; default as the quality says",
    .lowest = 100,
    .highest = 1e8,
    .preset = {20000, 100000, 400000, 1600000},
    .for_target = emitter_knobs::particles_for,
    .label = "%g particles",
    .matters = emitter_knobs::is_lit};

/// Rays of a receiver to an emitter's surfaces, and to other surfaces.
inline constexpr KnobSpec kEmitterRays{
    .name = "emitter_rays",
    .option = "--emitter-rays",
    .placeholder = "N",
    .help =
        "rays of each receiver to an emitter, and as many to surfaces that reflect the light of "
        "all; default as the quality says",
    .lowest = 1,
    .highest = 1e6,
    .preset = {128, 512, 1024, 4096},
    .for_target = emitter_knobs::rays_for,
    .label = "%g rays",
    .matters = emitter_knobs::is_lit};

}  // namespace opaline::bake
