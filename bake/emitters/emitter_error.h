#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/emitters/lamp_sources.h"
#include "bake/emitters/receiver_light.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/ray_scene.h"
#include "bake/volumes/density_space.h"
#include "bake/volumes/glow_space.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// How far rows of emitters err.
struct EmitterErrorReport {
    /// RMS of the error of luminance over the RMS of the truth, of all emitters as authored
    /// together, the noise of the truth taken off; no less than what the check can resolve, which
    /// is the standard error of the mean square.
    double rms_relative = 0;
    std::uint32_t receivers_checked = 0;
};

/// What a check compares.
struct EmitterCheck {
    const formats::Scene& scene;
    const RayScene& rays;
    std::span<const ReceiverSet> receivers;
    std::span<const formats::PrimitiveRecord> primitives;
    std::span<const LampSources> sources;
    formats::EmittersView emitters;
    /// What media send out, and what metals and media alone pass on from lamps, are taken from here
    /// as they are; null: nothing.
    const LampLight* known = nullptr;
    const DensitySpace* volumes = nullptr;   ///< that stand between surfaces; null: none
    std::span<const GlowingGrid> glow = {};  ///< of them, those that are lamps
};

/// Compares the first row of receivers drawn at random, opaque ones, with path tracing: a point of
/// an emitter's surface and one of the lights at every vertex, and any number of bounces, diffuse
/// or mirrored by metal; at media they end in what is known of these, or go straight through. In
/// volumes they are scattered and gather the volumes' own light; light of other lamps is dimmed.
/// Receivers in creases, with a surface nearer than a thousandth of the scene, are left out: there
/// paths lose their way in rounding. Precondition: at least one source.
/// It shares surfaces' colours with what it checks, but no elements, particles or form factors.
EmitterErrorReport check_emitters(const EmitterCheck& check, std::uint64_t seed,
                                  const Context& context, std::uint64_t& rays);

/// Irradiance [lx] of a receiver from all lamps, by `paths` paths. (seed, key): key the numbers.
glm::dvec3 trace_irradiance(const EmitterCheck& check, const Receiver& receiver,
                            std::uint32_t paths, std::uint64_t seed, std::uint64_t key,
                            std::uint64_t& rays);

}  // namespace opaline::bake
