#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

struct Scatterer;

/// Which scatterers may answer a ray: those of the surface's material and side that face as it
/// does.
struct SurfaceSide {
    std::uint32_t material = 0;
    bool behind = false;
    glm::vec3 normal{0};  ///< unit, of that side
};

/// kd-trees over scatterers, one for each material, side and nearest axis of the normal, so that
/// the two sides of a thin part never mix. Every node has a row: the mean of its scatterers'.
class BounceTree {
  public:
    /// `materials`: of the scene. Rows of `row_size` floats are 0 until set_rows.
    BounceTree(std::span<const Scatterer> scatterers, std::size_t materials, std::size_t row_size);

    /// `rows`: of all scatterers, one after the other.
    void set_rows(std::span<const float> rows);

    /// Toward y, the first node of an area of at most `footprint` [m^2]; 0: the scatterer in whose
    /// cell y is. formats::kNone where that side of the material has no scatterer.
    std::uint32_t find(glm::vec3 y, const SurfaceSide& side, float footprint) const;

    std::span<const float> row(std::uint32_t node) const {
        return std::span(rows_).subspan(node * row_size_, row_size_);
    }
    std::size_t size() const { return nodes_.size(); }
    std::size_t row_size() const { return row_size_; }

  private:
    struct Node {
        float split = 0, area = 0;  // [m], [m^2] of the bounding box's largest side
        std::uint32_t right = 0;    // second child; the first follows the node; 0: a leaf
        std::uint32_t count = 0;    // scatterers
        std::uint32_t axis = 0;     // 0 ... 2; of a leaf: its scatterer
    };
    void build(std::span<const Scatterer> scatterers, std::span<std::uint32_t> members);
    std::uint32_t root_of(const SurfaceSide& side) const;

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> roots_;  // by material, side and axis
    std::vector<float> rows_;
    std::size_t row_size_;
};

}  // namespace opaline::bake
