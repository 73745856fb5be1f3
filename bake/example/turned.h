#pragma once

#include <glm/glm.hpp>
#include <span>

#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

/// A point of a profile: its distance from the axis, its height, and its normal in that plane, of
/// any length. An edge has a point for each of its two normals.
struct ProfilePoint {
    double radius = 0, height = 0;
    glm::dvec2 normal{1, 0};
};

/// The profile turned about +Y, with `around` cells; from below to above its outside is in front.
TriangleMesh turn_about_axis(std::span<const ProfilePoint> profile, unsigned around);

}  // namespace opaline::bake
