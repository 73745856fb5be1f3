#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/effects/volumes/glow_walks.h"
#include "bake/exchange/lamp_bounces.h"
#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// What a check compares.
struct EmitterCheck {
    const formats::Scene& scene;
    const RayScene& rays;
    std::span<const ReceiverSet> receivers;
    std::span<const formats::PrimitiveRecord> primitives;
    std::span<const LampSources> sources;
    formats::EmittersView emitters;
    /// Source of what media send out and of caustics, which are not estimated anew; null: none.
    const LampBounces* known = nullptr;
    const DensitySpace* volumes = nullptr;   ///< between surfaces; null: none
    std::span<const GlowingGrid> glow = {};  ///< of them, those that are lamps
    bool scatters_lamps = false;  ///< light of the other lamps, as the file has it in them
};

/// The glowing triangles of all lamps, by power, and all lights.
struct TrueSources {
    std::vector<GlowingTriangle> triangles;
    std::vector<double> cumulative;
    std::vector<formats::Light> lights;
    std::vector<glm::dvec3> around_triangle, around_light;  ///< LampSources::extinction of each
};

TrueSources collect_true_sources(std::span<const LampSources> lamps);

/// Irradiance [lx] of a receiver from all lamps, by `paths` paths backward from it: a point of
/// an emitter's surface and one of the lights at every vertex, and any number of bounces, diffuse
/// or mirrored by metal; at media they end in what is known of these, or go on as their boundary
/// mirrors them. In volumes they are scattered and gather the volumes' own light, and that of other
/// lamps where volumes scatter it. It shares surfaces' colours with what it checks, but no
/// elements, particles or form factors. `sources`: those of check.sources. (seed, key): key the
/// numbers. `rays` counts those traced.
glm::dvec3 trace_irradiance(const EmitterCheck& check, const TrueSources& sources,
                            const Receiver& receiver, std::uint32_t paths, std::uint64_t seed,
                            std::uint64_t key, std::uint64_t& rays);

}  // namespace opaline::bake
