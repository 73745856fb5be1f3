#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace opaline::formats {

/// A vertex that no scene file has: where the baker needs a receiver between those of a triangle.
/// Fixed size, stored as is.
struct AddedVertex {
    std::array<std::uint32_t, 3> corner{};  ///< of that triangle: vertices that the scene file has
    std::array<float, 2> weight{};  ///< barycentric, of the second and the third; each in [0, 1],
                                    ///< and so is what they leave to the first

    std::array<float, 3> weights() const {
        return {1.0f - weight[0] - weight[1], weight[0], weight[1]};
    }
};
static_assert(sizeof(AddedVertex) == 20);

/// Of all primitives of an asset; formats/README.md, `REFI`. Immutable.
struct AddedVerticesView {
    /// For each primitive how many of its vertices, the last ones, were added; empty: none of any.
    std::span<const std::uint32_t> count;
    std::span<const AddedVertex> vertex;  ///< primitive after primitive

    bool empty() const { return count.empty(); }
    std::uint32_t of(std::size_t primitive) const { return count.empty() ? 0 : count[primitive]; }
};

/// Owning twin of `AddedVerticesView`: what the baker builds.
struct AddedVertices {
    std::vector<std::uint32_t> count;
    std::vector<AddedVertex> vertex;

    AddedVerticesView view() const { return {count, vertex}; }
};

}  // namespace opaline::formats
