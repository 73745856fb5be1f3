#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/emitters/lamp_sources.h"
#include "bake/emitters/surface_elements.h"
#include "bake/transport/ray_scene.h"

namespace opaline::bake {

struct ParticleRun {
    std::uint32_t particles = 0;  ///< at least 1
    std::uint32_t lamp = 0;       ///< keys the random numbers, with the seed
    std::uint64_t seed = 0;
    /// Nothing: the footprint chooses the level of an element. Else all power goes to elements of
    /// about this area [m^2]: for comparisons.
    double fixed_area = 0;
    /// Colours of surfaces are means over the footprint; null: of points.
    const ScenePyramids* textures = nullptr;
};

/// Power [lm] that a lamp brings to each element of a scene, by particles [Suykens2001].
///
/// A particle of 1 / N of the lamp's power gives it, at each surface that it meets, to the largest
/// element that is not larger than 4^(u - 1/4) times its footprint, u a random number that evens
/// out the factors of four between levels. The footprint is the polygon of global steps (N
/// survival)^(-1/M), limited where its contribution varies. It goes on with the probability of the
/// surface's largest band. One element takes all of it, so the sum over elements is what arrived.
/// The same bits for any number of threads. `rays` counts those traced.
std::vector<glm::dvec3> trace_particles(const formats::Scene& scene, const RayScene& rays_scene,
                                        const LampSources& lamp, const ElementLayout& layout,
                                        const ParticleRun& run, const Context& context,
                                        std::uint64_t& rays);

}  // namespace opaline::bake
