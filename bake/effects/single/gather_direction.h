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

/// Data shared by all directions; the references must outlive the job.
struct GatherJob {
    const RayScene& rays;
    const BodyMesh& mesh;
    std::uint32_t size;  ///< of views [pixels]
    const SingleMedium& medium;
    const NodeList& list;
    std::uint32_t terms;
    float isotropic;  ///< the value of the term if K = 1
    ColumnMedium column;
};
GatherJob make_gather_job(const RayScene& rays, const BodyMesh& mesh, std::uint32_t size,
                          const SingleMedium& medium, const NodeList& list);

/// A thread's buffers and counters.
struct GatherWorkspace {
    LightView view;
    ColumnAnswers answers;
    std::vector<float> value;  ///< sums, [receiver][term][band]
    struct Open {
        const InteriorNode* node;
        std::uint32_t receiver;
        float factor;
    };
    std::vector<Open> open;  ///< look-ups to be decided by rays
    struct Unclear {
        std::uint32_t node, receiver, triangle;  ///< the triangle seen nearest to the node
    };
    std::vector<Unclear> unclear;  ///< of a block
    EntryCounts counts;
    std::uint64_t look_ups = 0, unsure = 0;
};

/// Adds the light that all receivers get from one direction to `work.value`. Renders the boundary
/// along the direction, looks up every node, and traces the nodes that the view cannot decide.
/// `jitter`: of the view's grid, in [0, 1)^2.
void gather_direction(const GatherJob& job, const GatherDirection& direction, glm::vec2 jitter,
                      GatherWorkspace& work);

}  // namespace opaline::bake
