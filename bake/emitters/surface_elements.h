#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// A side of a triangle of a scene.
struct TriangleSide {
    std::uint32_t primitive = 0, first_index = 0;  ///< of its first corner in Primitive::index
    bool is_back = false;                          ///< the side that its normal points away from
};

/// Elements of all triangles of a scene in hierarchies: level l cuts a triangle's edges into 2^l
/// parts, which makes 4^l triangles alike. Sides that reflect nothing, backs of single-sided
/// surfaces, have no elements.
class ElementLayout {
  public:
    /// The finest elements are about as large as `finest` [m^2] and not smaller, but of a triangle
    /// of twice that area or less there is one. Preconditions: finest > 0; fewer than 2^32
    /// elements.
    ElementLayout(const formats::Scene& scene, double finest);

    /// Elements of all levels.
    std::size_t size() const { return size_; }

    /// The largest element around a point that is not larger than the footprint [m^2], or the
    /// finest one; size() where the side has none. `weights`: barycentric.
    std::size_t element(const TriangleSide& side, const glm::dvec3& weights,
                        double footprint) const;

    /// The finest element around a point, or size().
    std::size_t finest_element(const TriangleSide& side, const glm::dvec3& weights) const {
        return element(side, weights, 0);
    }

    /// Irradiance of each element from the power that each took itself [lm]: the sum over it and
    /// those that it is part of, power over area.
    std::vector<glm::vec3> push_down(std::span<const glm::dvec3> power) const;

  private:
    struct Hierarchy {
        std::uint32_t first = 0;  // element; its children follow level by level
        std::uint32_t levels = 0;
        double area = 0;
    };
    const Hierarchy* find(const TriangleSide& side) const;

    std::vector<std::uint32_t> first_;  // of each primitive, into hierarchies_
    std::vector<std::uint32_t> sides_;  // of each primitive, 1 or 2
    std::vector<Hierarchy> hierarchies_;
    std::size_t size_ = 0;
};

/// Sum of the areas of all sides that have elements [m^2].
double reflecting_area(const formats::Scene& scene);

}  // namespace opaline::bake
