#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/effects/multiple/walks/medium_stack.h"
#include "bake/effects/multiple/walks/walk.h"
#include "bake/effects/multiple/walks/walk_space.h"

namespace opaline::bake {

/// Share of light that passes a smooth boundary. `ratio`: index beyond it over that before it.
float boundary_transmittance(float cosine, float ratio);

/// The direction of a walk's first flight, into the half space below both normals of its start,
/// with density F_t(c) c over the outer hemisphere, refracted by the smooth normal; where that
/// leads above the facet, by the facet's.
glm::vec3 start_direction(const WalkSpace& space, const WalkStart& start, WalkRandom& random);

/// What lies beyond a surface that a walk has met.
struct FarSide {
    MediumStack bodies;
    float side = 1;            ///< where the triangle's normal points along the walk, else -1
    float lift = 0;            ///< [m], clear of the surface
    bool has_room = true;      ///< false: it lies in more materials than a stack holds
    bool meets_other = false;  ///< another body than the space's own is met there
};

/// The flight that ended at the surface: from `position` [m], `way` [m] long.
struct WalkFlight {
    glm::vec3 position{0}, direction{0};
    float way = 0;
};

/// `bodies`: around the flight. Faces that lie on one another are crossed as one
/// (WalkSpace::bodies). Where there are several, at an edge, or where the walk leaves what it was
/// not in, the bodies beyond are counted anew, in the middle of the way to the next surface. `rays`
/// counts up.
FarSide find_far_side(const WalkSpace& space, const MediumStack& bodies, const WalkFlight& flight,
                      const WalkHit& hit, std::uint64_t& rays);

/// How light goes on at a smooth surface between two media: either way whole, by chance.
struct Bend {
    glm::vec3 reflected{0}, refracted{0};  ///< unit
    float passed = 0;                      ///< the chance of the latter
};

/// By the smooth normal, unless it sends light to the wrong side of the triangle. `side`:
/// FarSide's; `ratio`: index beyond over that before, not 1.
Bend bend_at(const WalkSpace& space, const WalkHit& hit, float side, glm::vec3 direction,
             float ratio);

}  // namespace opaline::bake
