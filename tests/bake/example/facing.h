#pragma once

#include <gtest/gtest.h>

#include "bake/lab/example/triangle_mesh.h"

namespace opaline::bake {

/// Expects that its triangles have an area and face where their vertices' normals do.
inline void expect_facing_normals(const TriangleMesh& mesh) {
    ASSERT_EQ(mesh.position.size(), mesh.normal.size());
    ASSERT_FALSE(mesh.triangles.empty());
    for (const Triangle& t : mesh.triangles) {
        const glm::dvec3 cross = glm::cross(mesh.position[t[1]] - mesh.position[t[0]],
                                            mesh.position[t[2]] - mesh.position[t[0]]);
        EXPECT_GT(glm::dot(cross, mesh.normal[t[0]] + mesh.normal[t[1]] + mesh.normal[t[2]]), 0);
        EXPECT_NEAR(glm::length(mesh.normal[t[0]]), 1, 1e-12);
    }
}

/// Of a closed mesh; negative where it faces inward.
inline double enclosed_volume(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += glm::dot(mesh.position[a], glm::cross(mesh.position[b], mesh.position[c])) / 6;
    }
    return sum;
}

}  // namespace opaline::bake
