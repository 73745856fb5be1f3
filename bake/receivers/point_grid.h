#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "bake/receivers/surface_points.h"

namespace opaline::bake {

/// Normals at more than 120 degrees belong to different sides of a sheet; those of a box's edge do
/// not.
inline bool on_same_side(glm::vec3 normal_a, glm::vec3 normal_b) {
    return glm::dot(normal_a, normal_b) > -0.5f;
}

/// Points in cubic cells. Keeps a reference to the points.
class PointGrid {
  public:
    PointGrid(const std::vector<SurfacePoint>& points, float cell) : points_(points), cell_(cell) {
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            cells_[key(coordinates(points[i].position))].push_back(i);
        }
    }

    /// Calls visit(j, distance) for all points nearer than `radius`, at most a cell's side, that
    /// are on the same side as point i, but not for i itself.
    template <class Visit>
    void for_each_near(std::uint32_t i, float radius, Visit&& visit) const {
        for_each_around(points_[i].position, [&](std::uint32_t j) {
            const float d = glm::distance(points_[i].position, points_[j].position);
            if (j != i && d < radius && on_same_side(points_[i].normal, points_[j].normal)) {
                visit(j, d);
            }
        });
    }

    /// Calls visit(j) for all points of the 27 cells around `position`.
    template <class Visit>
    void for_each_around(glm::vec3 position, Visit&& visit) const {
        const glm::ivec3 centre = coordinates(position);
        for (int dz = -1; dz <= 1; ++dz) {
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx) {
                    const auto cell = cells_.find(key(centre + glm::ivec3(dx, dy, dz)));
                    if (cell == cells_.end()) {
                        continue;
                    }
                    for (const std::uint32_t j : cell->second) {
                        visit(j);
                    }
                }
            }
        }
    }

    /// Names the cell of a position.
    std::uint64_t cell_of(glm::vec3 position) const { return key(coordinates(position)); }

  private:
    glm::ivec3 coordinates(glm::vec3 p) const { return glm::ivec3(glm::floor(p / cell_)); }
    static std::uint64_t key(glm::ivec3 c) {
        const auto part = [](int x) { return static_cast<std::uint64_t>(x) & 0x1fffffu; };
        return part(c.x) | part(c.y) << 21 | part(c.z) << 42;
    }

    const std::vector<SurfacePoint>& points_;
    float cell_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace opaline::bake
