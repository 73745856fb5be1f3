#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/exchange/lamps/surface_elements.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// Flights of a particle in the medium around its lamp; what is left of its light is lost.
inline constexpr std::uint32_t kMostFlightsInside = 4096;

struct ParticleRun {
    std::uint32_t particles = 0;  ///< at least 1
    std::uint32_t lamp = 0;       ///< keys the random numbers, with the seed
    std::uint64_t seed = 0;
    /// 0: footprints are those of paths. Else all count as this large [m^2]: for comparisons.
    double fixed_area = 0;
    /// Colours of surfaces are means over the footprint; null: of points.
    const ScenePyramids* textures = nullptr;
    bool ends_diffuse = false;              ///< particles end where they scatter diffusely
    double gradient_limit = 0.7;            ///< of footprints; infinite, for comparisons: none
    const DensitySpace* volumes = nullptr;  ///< that dim particles; null: none
    /// Material of the scattering medium around the lamp, homogeneous; formats::kNone: none.
    std::uint32_t medium = formats::kNone;
};

/// What a lamp's particles brought to elements.
struct ParticleLight {
    std::vector<ElementDeposit> all;
    /// What metals and media alone passed on from the lamp: a part of `all`. Empty: nothing.
    std::vector<ElementDeposit> caustic;
    /// What leaves the medium around the lamp after it has scattered there, by elements of its
    /// outside; no part of the others. Empty: nothing.
    std::vector<ElementDeposit> leaving;
};

/// Light of a lamp at each element of a scene, by particles [Suykens2001].
///
/// A particle of 1 / N of the lamp's power gives it, at each surface that it meets, to the element
/// there, with its footprint: the polygon of global steps (N survival)^(-1/M), limited where its
/// contribution varies. It goes on, reflected diffusely or mirrored by metal, with the probability
/// of the larger band, or straight through a medium, attenuated. In the medium around its lamp it
/// scatters, until it leaves that by chance, as the boundary says: there it ends, or goes on if it
/// has not scattered since a surface. The sum over elements is what arrived. The same bits for any
/// number of threads. `rays` counts those traced.
ParticleLight trace_particles(const formats::Scene& scene, const RayScene& rays_scene,
                              const LampSources& lamp, const ElementLayout& layout,
                              const ParticleRun& run, const Context& context, std::uint64_t& rays);

}  // namespace opaline::bake
