#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/effects/single/light_columns.h"
#include "bake/effects/single/light_view.h"
#include "bake/effects/single/node_list.h"
#include "bake/effects/single/ray_single.h"

namespace opaline::bake {

/// One direction of light.
struct GatherDirection {
    glm::vec3 w;  ///< unit, toward the light
    float share;  ///< of its texel's solid angle
};

/// What is the same for all directions; the references must outlive it.
struct GatherJob {
    const RayScene& rays;
    const BodyMesh& mesh;
    std::uint32_t size;  ///< of views [pixels]
    const SingleMedium& medium;
    const NodeList& list;
    std::uint32_t terms;
    float isotropic;  ///< the only term where there is one
    ColumnMedium column;
};
GatherJob make_gather_job(const RayScene& rays, const BodyMesh& mesh, std::uint32_t size,
                          const SingleMedium& medium, const NodeList& list);

/// What a thread works with, and what it counts.
struct GatherWorkspace {
    LightView view;
    ColumnAnswers answers;
    std::vector<float> value;  ///< sums, [receiver][term][band]
    struct Open {
        const InteriorNode* node;
        std::uint32_t receiver;
        float factor;
    };
    std::vector<Open> open;  ///< what rays must find out
    struct Unclear {
        std::uint32_t node, receiver, triangle;  ///< the one seen nearest to it
    };
    std::vector<Unclear> unclear;  ///< of a block
    EntryCounts counts;
    std::uint64_t look_ups = 0, unsure = 0;
};

/// Adds what all receivers get from one direction to `work.value`: renders the boundary along it,
/// looks every node up, and traces the nodes for which that tells too little. `jitter`: of the
/// view's grid, in [0, 1)^2.
void gather_direction(const GatherJob& job, const GatherDirection& direction, glm::vec2 jitter,
                      GatherWorkspace& work);

}  // namespace opaline::bake
