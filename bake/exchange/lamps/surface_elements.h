#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/exchange/lamps/triangle_clusters.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A side of a triangle of a scene.
struct TriangleSide {
    std::uint32_t primitive = 0, first_index = 0;  ///< of its first corner in Primitive::index
    bool is_back = false;                          ///< the side that its normal points away from
};

/// What particles gave to an element.
struct ElementDeposit {
    glm::dvec3 power{0};        ///< [lm]
    double weight = 0;          ///< sum of largest bands [lm]
    double weight_squares = 0;  ///< sum of their squares
    double log_footprint = 0;   ///< sum of largest bands times ln of the footprint [m^2]
};

/// Whether any element took light.
bool has_light(std::span<const ElementDeposit> deposits);

/// Where an element is.
struct ElementPlace {
    glm::vec3 position{0}, normal{0};  ///< [m], its middle; unit, of the side
    std::uint32_t material = 0;
    bool is_back = false;
    float area = 0;  ///< [m^2]
};

/// Light of all elements.
struct ElementLight {
    std::vector<glm::vec3> irradiance;    ///< [lx]
    std::vector<std::uint32_t> together;  ///< the first of those joined with it at s = sqrt(2)

    bool empty() const { return irradiance.empty(); }
};

/// How far elements join.
struct JoinRule {
    double share = 1;      ///< by which footprints count smaller, in (0, 1]
    double particles = 0;  ///< groups of fewer, were all alike, join beyond their footprints
};

/// Elements of all triangles of a scene: 4^l triangles alike, cuts of its edges into 2^l parts.
/// Elements of a triangle join to those of fewer levels, and triangles of connected patches join to
/// clusters. Sides that reflect nothing, backs of single-sided surfaces, have no elements.
class ElementLayout {
  public:
    /// Elements are about as large as `finest` [m^2] and not smaller, but of a triangle of twice
    /// that area or less there is one. Preconditions: finest > 0; fewer than 2^32 elements.
    ElementLayout(const formats::Scene& scene, double finest);

    std::size_t size() const { return size_; }

    /// The element around a point, or size() where the side has none. `weights`: barycentric.
    std::size_t element(const TriangleSide& side, const glm::dvec3& weights) const;

    /// By element. `scene`: the one that they are of.
    std::vector<ElementPlace> places(const formats::Scene& scene) const;

    /// Joins elements as far as footprints reach, and spreads the power of each group over its
    /// area. Siblings join if all are whole and their parent is not larger than s times the
    /// footprints in it, in the mean of logarithms weighted by power. What arrives where nothing
    /// else did joins anything. Levels are a factor of four apart: the mean over three sizes s
    /// around sqrt(2), spread over that factor, follows the footprint. Every group's mean is what
    /// arrived in it over its area.
    ElementLight join(std::span<const ElementDeposit> deposits, const JoinRule& rule = {}) const;

  private:
    struct Hierarchy {
        std::uint32_t first = 0;  // element
        std::uint32_t levels = 0;
        double area = 0;
    };
    class Joining;
    const Hierarchy* find(const TriangleSide& side) const;

    std::vector<std::uint32_t> first_;        // of each primitive, into hierarchies_
    std::vector<std::uint32_t> sides_;        // of each primitive, 1 or 2
    std::vector<TriangleClusters> clusters_;  // of each primitive
    std::vector<Hierarchy> hierarchies_;
    std::size_t size_ = 0;
};

/// Sum of the areas of all sides that have elements [m^2].
double reflecting_area(const formats::Scene& scene);

}  // namespace opaline::bake
