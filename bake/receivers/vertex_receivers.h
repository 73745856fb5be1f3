#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "formats/scene.h"

namespace opaline::bake {

/// One receiver per vertex, in output order: primitives one after the other.
///
/// Rays must not hit the triangles they start on, and must hit all others. A vertex lies on all its
/// triangles at once, so its rays start at
///     origin = position + (bound / clearance) * d,
/// d: the direction that stays farthest in front of all triangles meeting at that position (welded
///    over primitives and vertex duplicates: a floor that meets a wall counts), found by a
///    perceptron iteration; clearance: the smallest cosine between d and their normals;
/// bound: clearance_bound at the vertex.
/// Duplicated vertices therefore get identical origins, and no seam.
/// Where no d is in front of all triangles and another medium's body lies against that of the
/// vertex, d is in front of the triangles of its own primitive. Where there is none either (a point
/// whose triangles are folded over each other, as scans and decimation leave them), rays start
/// along the shading normal above the fold, which would else be a black speck.
std::vector<Receiver> make_vertex_receivers(const formats::Scene& scene);

/// Bound [m] on how far the computed intersection of a ray with a triangle may lie from the true
/// one, for coordinates up to `magnitude` [m], in the frame that rays run in.
float intersection_error_bound(float magnitude);

/// The receiver as a copy of its mesh has it (formats::CopyOf): moved, and in front of its
/// triangles whatever its coordinates round to there.
Receiver moved(const Receiver& receiver, glm::vec3 offset);

/// The same bound for a ray that starts at `position` and triangles whose corners differ from it by
/// at most `extent` [m] on each axis. It depends on local rounding only, not on the scene's size.
float clearance_bound(glm::vec3 position, float extent);

/// The unit direction d that maximises the smallest dot(d, normal), and that dot product, which is
/// not positive where the normals do not fit into an open half space.
struct Clearance {
    glm::vec3 direction{0, 0, 0};
    float cosine = -1;
};
Clearance clearest_direction(std::span<const glm::vec3> normals);
/// Where the cosine is no larger, a crease is closed for every purpose.
inline constexpr float kLeastClearance = 0.02f;

}  // namespace opaline::bake
