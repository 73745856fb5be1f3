#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/exchange/bounce_light.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/lamps/receiver_light.h"
#include "bake/exchange/particle_cells.h"
#include "bake/trace/coded_rows.h"

namespace opaline::bake {

/// Light of lamps and what surfaces send to each other of it: a column for each lamp of the
/// exchange that the sky's light has.
struct LampBounces {
    const LampLight& lamps;
    const BounceLight* surfaces = nullptr;  ///< null: none sends any
    BounceGrid of_receiver{}, of_averaged{};
    /// Of each lamp B at the nodes of the tree [lm/m^2], three bands; an empty one: no surface
    /// sends any.
    std::vector<CodedRows> sent{};

    bool empty() const;
};

/// What particles of a lamp brought to cells of scatterers until they scattered: from the lamp
/// itself, and as metals and media passed it on. Empty: nothing, or nobody asked.
struct ArrivedParticles {
    ParticleCells straight, caustic;
    ParticleCells leaving;  ///< what leaves the medium around the lamp there
};

/// Solves for the light that surfaces send out of what arrives at first: at points of scatterers
/// straight from the lamps, or as particles have it where these know better, and in their cells by
/// way of metals and media. What the boundary of a medium or a coat mirrors of both goes on as if
/// diffuse.
/// `surfaces`: with arrivals, or null; it and `lamps` must outlive the result. `arrived`: of each
/// lamp.
LampBounces find_lamp_bounces(const LampLight& lamps, const BounceLight* surfaces,
                              std::span<const ArrivedParticles> arrived, const Context& context,
                              std::uint64_t& rays);

/// Irradiance [lx] of a point from each lamp: straight, and from surfaces that as many rays meet.
/// (seed, key): key the rotation of rays to volumes that glow.
std::vector<glm::dvec3> receive_light(const LampBounces& light, const LitPoint& point,
                                      std::uint64_t key, std::uint64_t& rays);

/// B at a node of the tree [lm/m^2] by one lamp.
glm::dvec3 sent_by(const LampBounces& light, std::size_t lamp, std::size_t node);

/// What surfaces send out of all lamps where a ray meets one [lm/m^2]: that of the nearest
/// scatterer.
glm::dvec3 find_sent(const LampBounces& light, const glm::vec3& position, const SurfaceSide& side);

}  // namespace opaline::bake
