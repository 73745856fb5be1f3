#include "bake/receivers/centre_in_cells.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/point_grid.h"

namespace opaline::bake {
namespace {

// The nearest point on the same side of the surface, or the nearest of all if that side has none.
std::uint32_t find_nearest(const std::vector<SurfacePoint>& points,
                           const std::vector<std::uint32_t>& candidates, const SurfacePoint& to) {
    std::uint32_t nearest = 0;
    float least = std::numeric_limits<float>::max();
    bool same_side = false;
    for (const std::uint32_t j : candidates) {
        const glm::vec3 d = points[j].position - to.position;
        const float distance = glm::dot(d, d);
        const bool same = on_same_side(points[j].normal, to.normal);
        if ((same && !same_side) || (same == same_side && distance < least)) {
            nearest = j;
            least = distance;
            same_side = same;
        }
    }
    return nearest;
}

// The cell of every point of `dense`, as an index into `points`.
std::vector<std::uint32_t> assign(const std::vector<SurfacePoint>& points,
                                  const std::vector<SurfacePoint>& dense, double spacing,
                                  const Context& context) {
    // In a maximal set no position on the surface is farther than about one spacing from a point.
    const PointGrid grid(points, static_cast<float>(1.2 * spacing));
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<std::uint32_t> cell;
    cell.reserve(dense.size());
    for_each_block_in_order(
        dense.size(), 4096, context,
        [&](Range range) {
            std::vector<std::uint32_t> found, around;
            std::uint64_t at = 0;  // the cell whose neighbours `around` holds
            for (std::size_t k = range.begin; k < range.end; ++k) {
                const std::uint64_t here = grid.cell_of(dense[k].position);
                if (k == range.begin || here != at) {
                    grid.collect_around(here, around);
                    at = here;
                }
                found.push_back(find_nearest(points, around.empty() ? all : around, dense[k]));
            }
            return found;
        },
        [&](Range, const std::vector<std::uint32_t>& found) {
            cell.insert(cell.end(), found.begin(), found.end());
        });
    cell.resize(dense.size());  // in case of cancellation
    return cell;
}

// The point of `near`'s triangle below `target`, if the perpendicular meets the triangle.
SurfacePoint move_within_triangle(const formats::Scene& scene, const SurfacePoint& near,
                                  glm::dvec3 target) {
    const formats::Primitive& p = scene.primitives[near.primitive];
    const glm::dvec3 a = p.position[p.index[near.first_index]];
    const glm::dvec3 ab = glm::dvec3(p.position[p.index[near.first_index + 1]]) - a;
    const glm::dvec3 ac = glm::dvec3(p.position[p.index[near.first_index + 2]]) - a;
    const glm::dvec3 n = glm::cross(ab, ac), at = target - a;
    const double v = glm::dot(glm::cross(at, ac), n) / glm::dot(n, n);
    const double w = glm::dot(glm::cross(ab, at), n) / glm::dot(n, n);
    if (!(v >= 0 && w >= 0 && v + w <= 1)) {
        return near;
    }
    return make_surface_point(scene, {near.primitive, near.first_index},
                              glm::vec3(1 - v - w, v, w));
}

}  // namespace

std::vector<float> centre_in_cells(const formats::Scene& scene, const AreaTable& table,
                                   double spacing, std::uint64_t seed,
                                   std::vector<SurfacePoint>& points, const Context& context) {
    constexpr std::size_t kPerCell = 16;
    const std::vector<SurfacePoint> dense =
        scatter_points(scene, table, kPerCell * points.size(), true, seed);
    const std::vector<std::uint32_t> cell = assign(points, dense, spacing, context);
    std::vector<glm::dvec3> centre(points.size(), glm::dvec3(0));
    std::vector<std::uint32_t> count(points.size(), 0);
    for (std::size_t k = 0; k < dense.size(); ++k) {
        centre[cell[k]] += glm::dvec3(dense[k].position);
        ++count[cell[k]];
    }
    std::vector<float> area(points.size());
    std::vector<double> least(points.size(), std::numeric_limits<double>::max());
    std::vector<std::size_t> nearest(points.size());
    for (std::size_t k = 0; k < dense.size(); ++k) {
        const std::uint32_t i = cell[k];
        const double d =
            glm::distance(glm::dvec3(dense[k].position), centre[i] / static_cast<double>(count[i]));
        if (d < least[i]) {
            least[i] = d;
            nearest[i] = k;
        }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        area[i] = static_cast<float>(table.total() * count[i] / static_cast<double>(dense.size()));
        if (count[i] > 0) {
            points[i] = move_within_triangle(scene, dense[nearest[i]],
                                             centre[i] / static_cast<double>(count[i]));
        }
    }
    return area;
}

}  // namespace opaline::bake
