#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "bake/refine/edge_cut.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A scene's triangles while their edges are halved. Each edge is halved in all triangles that
/// share it, over seams, creases and primitives, so that no vertex ever lies on the edge of a
/// triangle of which it is no corner: edges are pairs of places, not of vertices. Only the longest
/// edge of a triangle is halved [Rivara1984]: where that is done in the middle, no angle becomes
/// smaller than half of the smallest one given. Meshes need not be manifold.
class SplitMesh {
  public:
    struct Triangle {
        std::uint32_t primitive = 0, first_index = 0;  ///< of the triangle given that it is part of
        std::array<std::uint32_t, 3> corner{};         ///< vertices of the primitive, in its order
        std::array<glm::vec3, 3> weight{};  ///< barycentric, of the corners in the triangle given
        std::uint32_t depth = 0;            ///< how often halved
    };
    /// A halved triangle: what was (a, b, c), turned by `side` so that its longest edge comes
    /// first, became `first`, (a, m, c), and `second`, (m, b, c), m lying where the edge was cut.
    struct Half {
        std::uint32_t first, second, side;
        std::uint32_t a, b, middle;  ///< vertices of the primitive
        EdgeCut cut;                 ///< from a to b
    };
    /// Says where an edge is cut that goes from one place [m] to another, by the unit normals of
    /// the triangles that share it.
    using CutRule = std::function<EdgeCut(glm::vec3, glm::vec3, std::span<const glm::vec3>)>;

    /// Triangles without area take no part. Keeps a copy of the scene. `rule`: a pure function;
    /// without one edges are cut in their middle.
    explicit SplitMesh(const formats::Scene& scene, CutRule rule = nullptr);

    const formats::Scene& scene() const { return scene_; }
    /// The scene with all vertices and triangles; the mesh is empty then.
    formats::Scene take();

    std::uint32_t size() const { return static_cast<std::uint32_t>(triangles_.size()); }
    const Triangle& operator[](std::uint32_t triangle) const { return triangles_[triangle]; }
    /// [m^2]
    double area(std::uint32_t triangle) const;
    /// The side whose edge, from corner `side` to the next one, is longest; equal ones in a fixed
    /// order.
    std::uint32_t longest_side(std::uint32_t triangle) const;
    double longest_edge(std::uint32_t triangle) const;  ///< [m]
    /// Where the longest edge is cut if it is halved, from its first corner to its second.
    EdgeCut cut_of(std::uint32_t triangle);
    /// Triangles that share an edge with it.
    std::vector<std::uint32_t> neighbours(std::uint32_t triangle);
    /// Vertices added to all primitives.
    std::uint64_t added() const { return added_; }

    /// Halves a triangle, and others first as far as edges are shared. Edges no longer than the
    /// given one's are left alone, so lengths that are far above rounding stay so. Appends what was
    /// halved, in order, to `halves`.
    void halve(std::uint32_t triangle, std::vector<Half>& halves);

  private:
    using Edge = std::uint64_t;  ///< two numbers of places, the smaller one first
    struct Length {
        double square;  ///< [m^2], to 16 bits: equal edges of a scaled or turned mesh stay equal
        Edge edge;

        auto operator<=>(const Length&) const = default;
    };

    std::uint32_t place_of(std::uint32_t triangle, std::uint32_t side) const;
    Length length_of(std::uint32_t triangle, std::uint32_t side) const;
    void link_all();  ///< where a mesh stays as it is, edges cost nothing
    void link(std::uint32_t triangle);
    void unlink(std::uint32_t triangle, std::uint32_t side);
    std::vector<std::uint32_t> sides_of(Edge edge) const;
    EdgeCut find_cut(Edge edge);  ///< from the smaller place to the larger one
    void halve_edge(Edge edge, std::vector<Half>& halves);
    std::uint32_t add_vertex(const Triangle& triangle, glm::vec3 weight, std::uint32_t place);

    formats::Scene scene_;
    CutRule rule_;
    std::unordered_map<Edge, EdgeCut> cut_;  ///< that were asked for
    std::vector<Triangle> triangles_;
    std::uint32_t given_ = 0;                        ///< triangles at first
    std::vector<std::vector<std::uint32_t>> place_;  ///< of each vertex of each primitive
    std::vector<glm::vec3> position_;                ///< of each place [m]
    std::unordered_map<Edge, std::uint32_t> first_;  ///< side 3 t + k of an edge's first triangle
    std::vector<std::uint32_t> next_;                ///< of the same edge, by side
    std::uint64_t added_ = 0;
};

}  // namespace opaline::bake
