#include "bake/example/turned.h"

#include <cmath>
#include <numbers>

namespace opaline::bake {

TriangleMesh turn_about_axis(std::span<const ProfilePoint> profile, unsigned around) {
    TriangleMesh mesh;
    for (const ProfilePoint& p : profile) {
        for (unsigned i = 0; i <= around; ++i) {
            const double turn = 2 * std::numbers::pi * (i % around) / around;
            const double s = std::sin(turn), c = std::cos(turn);
            mesh.position.push_back({p.radius * s, p.height, p.radius * c});
            mesh.normal.push_back(
                glm::normalize(glm::dvec3(p.normal.x * s, p.normal.y, p.normal.x * c)));
        }
    }
    const std::uint32_t row = around + 1;
    for (std::uint32_t j = 0; j + 1 < profile.size(); ++j) {
        // Two normals of one edge: nothing is between them.
        if (profile[j].radius == profile[j + 1].radius &&
            profile[j].height == profile[j + 1].height) {
            continue;
        }
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t v = j * row + i;
            if (profile[j].radius > 0) mesh.triangles.push_back({v, v + 1, v + row + 1});
            if (profile[j + 1].radius > 0) mesh.triangles.push_back({v, v + row + 1, v + row});
        }
    }
    return mesh;
}

}  // namespace opaline::bake
