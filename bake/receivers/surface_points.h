#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/rng.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A point on a triangle of a scene.
struct SurfacePoint {
    std::uint32_t primitive = 0;
    std::uint32_t first_index = 0;  ///< of its triangle, into Primitive::index
    glm::vec3 barycentric{0};
    glm::vec3 position{0}, normal{0};  ///< [m]; unit normal of the facet
};

/// The triangles of some primitives with an area above 0, in order.
struct AreaTable {
    struct Triangle {
        std::uint32_t primitive, first_index;
    };
    std::vector<Triangle> triangle;
    std::vector<double> cumulative;  ///< area of all up to and including this one [m^2]

    double total() const { return cumulative.empty() ? 0.0 : cumulative.back(); }
};

AreaTable make_area_table(const formats::Scene& scene,
                          const std::vector<std::uint32_t>& primitives);

/// Point at barycentric coordinates of a triangle.
SurfacePoint make_surface_point(const formats::Scene& scene, const AreaTable::Triangle& triangle,
                                glm::vec3 barycentric);

/// `count` points, uniform by area: one in each of `count` equal parts of the cumulative area, at a
/// random position in its triangle. `even`: a low-discrepancy set in large triangles, for
/// quadrature. (seed, stage): key the random numbers.
std::vector<SurfacePoint> scatter_points(const formats::Scene& scene, const AreaTable& table,
                                         std::size_t count, bool even, std::uint64_t seed,
                                         RandomStage stage = RandomStage::surface_samples);

}  // namespace opaline::bake
