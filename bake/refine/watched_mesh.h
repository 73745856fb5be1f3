#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "bake/base/context.h"
#include "bake/refine/interpolation_error.h"
#include "bake/refine/proxy_rows.h"
#include "bake/refine/split_mesh.h"

namespace opaline::bake {

/// A mesh that is divided, and what points of its triangles say about interpolation there.
///
/// Each triangle has points with proxy rows; their mean square beyond what the triangle's corners
/// interpolate is its error. Halved triangles hand their points to their parts. A part with fewer
/// than two gets the place where its longest edge is cut, whose row is its vertex's once that edge
/// is halved. Triangles that were never looked at are not watched, and neither are their parts.
class WatchedMesh {
  public:
    /// `shortest`: edges that matter are longer [m].
    WatchedMesh(const formats::Scene& scene, const RayScene& rays,
                std::span<const LampSources> lamps, std::uint32_t cubemap_size, double shortest,
                const Context& context);

    /// Forgets all points; then looks at one point in each of `count` equal parts of the surface.
    void look_first(std::size_t count, std::uint64_t seed);
    /// Halves a watched triangle and what must be halved with it. Its neighbours are watched from
    /// now on: where one triangle of a dense mesh errs, those beside it do.
    void halve(std::uint32_t triangle);
    /// Looks at what was halved since, and at its neighbours.
    void look_at_parts();

    const SplitMesh& mesh() const { return mesh_; }
    SplitMesh& mesh() { return mesh_; }
    bool is_watched(std::uint32_t triangle) const { return watched_[triangle].is_watched; }
    /// Mean square; 0 where nothing of it is seen.
    const ErrorColumns& error(std::uint32_t triangle) const { return watched_[triangle].error; }
    double area() const { return area_; }  ///< of all surfaces [m^2]
    /// Square of all light over the surface [m^2], flat open ground left out
    /// (square_where_shaded).
    const ErrorColumns& total() const { return total_; }
    /// Square of the error [m^2] where triangles are not watched, by what the others err by.
    const ErrorColumns& unseen() const { return unseen_; }
    std::uint64_t rays() const { return traced_; }

  private:
    struct Look {
        glm::vec3 weight;   // of the triangle's corners
        std::uint32_t row;  // of the proxies
        bool is_cut;        // of the longest edge
    };
    struct Watched {
        std::vector<Look> looks;
        bool is_watched = false;
        ErrorColumns error{};
    };
    struct VertexEdge {
        std::uint32_t primitive, low, high;

        bool operator==(const VertexEdge&) const = default;
    };
    struct EdgeHash {
        std::size_t operator()(const VertexEdge& edge) const;
    };

    void trace();
    float inset(std::uint32_t triangle) const;
    std::uint32_t await_row(std::uint32_t triangle, glm::vec3 weight);
    void look_at(std::span<const std::uint32_t> triangles);
    bool is_ground(std::uint32_t triangle) const;
    double contrast(std::uint32_t triangle) const;
    ErrorColumns square_at(std::uint32_t triangle, const Look& look) const;
    void measure(std::span<const std::uint32_t> triangles);
    void inherit(const SplitMesh::Half& half);

    const Context& context_;
    double shortest_;
    SplitMesh mesh_;
    ProxyTracer tracer_;
    ProxyRows rows_;
    std::vector<double> solid_angle_;    ///< of the cells of a face
    std::vector<Watched> watched_;       ///< of each triangle
    std::vector<std::uint32_t> parts_;   ///< halved and not looked at yet
    std::vector<std::uint32_t> joined_;  ///< watched and not looked at yet
    std::vector<std::vector<std::uint32_t>> vertex_row_;
    std::unordered_map<VertexEdge, std::uint32_t, EdgeHash> cut_row_;
    std::vector<ProxyPoint> awaited_;  ///< whose rows follow those of rows_
    double area_ = 0;
    ErrorColumns total_{}, unseen_{};
    std::uint64_t traced_ = 0;
};

}  // namespace opaline::bake
