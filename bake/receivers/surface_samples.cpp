#include "bake/receivers/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "bake/base/context.h"
#include "bake/base/ordered_parallel.h"
#include "bake/receivers/kd_order.h"
#include "bake/receivers/point_grid.h"
#include "bake/receivers/smooth_lift.h"
#include "bake/receivers/surface_points.h"
#include "bake/receivers/vertex_receivers.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

struct Neighbour {
    std::uint32_t point;
    float crowding;
};

// For every point, its neighbours within a radius on the same side.
struct Neighbours {
    std::vector<std::size_t> begin, end;  // into `list`
    std::vector<Neighbour> list;

    std::span<const Neighbour> of(std::uint32_t i) const {
        return std::span(list).subspan(begin[i], end[i] - begin[i]);
    }
};

Neighbours find_neighbours(const std::vector<SurfacePoint>& points, float radius,
                           const Context& context) {
    const PointGrid grid(points, radius);
    Neighbours all;
    all.begin.resize(points.size());
    all.end.resize(points.size());
    struct Part {
        std::vector<std::uint32_t> count;
        std::vector<Neighbour> list;
    };
    for_each_block_in_order(
        grid.cells(), 256, context,
        [&](Range range) {
            Part part;
            std::vector<std::uint32_t> around;
            for (std::size_t cell = range.begin; cell < range.end; ++cell) {
                grid.collect_around(grid.name_of(cell), around);
                for (const std::uint32_t i : grid.points_in(cell)) {
                    const std::size_t before = part.list.size();
                    for (const std::uint32_t j : around) {
                        const float d = glm::distance(points[i].position, points[j].position);
                        if (j != i && d < radius &&
                            on_same_side(points[i].normal, points[j].normal)) {
                            const float x = 1.0f - d / radius, x2 = x * x, x4 = x2 * x2;
                            part.list.push_back({j, x4 * x4});
                        }
                    }
                    part.count.push_back(static_cast<std::uint32_t>(part.list.size() - before));
                }
            }
            return part;
        },
        [&](Range range, const Part& part) {
            std::size_t at = all.list.size();
            auto count = part.count.begin();
            for (std::size_t cell = range.begin; cell < range.end; ++cell) {
                for (const std::uint32_t i : grid.points_in(cell)) {
                    all.begin[i] = at;
                    all.end[i] = at += *count++;
                }
            }
            all.list.insert(all.list.end(), part.list.begin(), part.list.end());
        });
    return all;
}

// Removes the most crowded points until `count` are left. Points whose crowding differs by a few
// per cent go in any order: the exact order needs a heap, which costs more than all the rest.
std::vector<std::uint32_t> thin_out(const Neighbours& neighbours, std::vector<double> weight,
                                    std::size_t count) {
    std::vector<std::uint32_t> left(weight.size());
    std::iota(left.begin(), left.end(), 0u);
    std::vector<bool> alive(weight.size(), true);
    constexpr double kStep = 0.98, kAlone = 1e-6;
    double limit = weight.empty() ? 0 : *std::max_element(weight.begin(), weight.end());
    std::size_t surplus = left.size() - std::min(count, left.size());
    while (surplus > 0) {
        limit = limit > kAlone ? kStep * limit : -1;
        for (const std::uint32_t i : left) {
            if (surplus == 0) break;
            if (weight[i] <= limit) continue;
            alive[i] = false;
            --surplus;
            for (const Neighbour& n : neighbours.of(i)) {
                weight[n.point] -= static_cast<double>(n.crowding);
            }
        }
        std::erase_if(left, [&](std::uint32_t i) { return !alive[i]; });
    }
    return left;
}

// Removes the most crowded point, or nearly the most crowded, until `count` are left [Yuksel2015,
// section 3]. Returns the indices of the remaining points, ascending. Points on different sides of
// a sheet do not crowd each other. `area`: of the surface [m^2].
std::vector<std::uint32_t> eliminate_crowded(const std::vector<SurfacePoint>& points,
                                             std::size_t count, double area,
                                             const Context& context) {
    const double r_max = std::sqrt(area / (2.0 * std::sqrt(3.0) * static_cast<double>(count)));
    const Neighbours neighbours = find_neighbours(points, static_cast<float>(2.0 * r_max), context);
    std::vector<double> weight(points.size(), 0.0);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        for (const Neighbour& n : neighbours.of(i)) {
            weight[i] += static_cast<double>(n.crowding);
        }
    }
    return thin_out(neighbours, std::move(weight), count);
}

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
    if (!(v >= 0 && w >= 0 && v + w <= 1)) return near;
    return make_surface_point(scene, {near.primitive, near.first_index},
                              glm::vec3(1 - v - w, v, w));
}

// One step of Lloyd's relaxation: moves each point to the centroid of the surface nearest to it,
// and measures the area of that cell. Sums weighted by these areas have a second-order error. With
// a spacing equal to the width of the summed profile, equal weights err by 5 %, these areas by 0.7
// %. `spacing` [m]: root of the area per point. Returns one area [m^2] per point; they add up to
// the table's.
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

}  // namespace

SurfaceSample make_surface_sample(const Scene& scene, const SurfacePoint& c, float area) {
    const Primitive& p = scene.primitives[c.primitive];
    SurfaceSample sample;
    sample.position = c.position;
    sample.geometric_normal = c.normal;
    sample.area = area;
    sample.primitive = c.primitive;
    glm::vec3 normal(0);
    float extent = 0;
    for (glm::length_t k = 0; k < 3; ++k) {
        const std::uint32_t v = p.index[c.first_index + static_cast<std::uint32_t>(k)];
        normal += c.barycentric[k] * p.normal[v];
        const glm::vec3 a = glm::abs(p.position[v] - c.position);
        extent = std::max({extent, a.x, a.y, a.z});
    }
    const float length = glm::length(normal);
    sample.normal = length > 0 && glm::dot(normal, c.normal) > 0 ? normal / length : c.normal;
    sample.receiver.normal = sample.normal;
    sample.receiver.origin = c.position +
                             lift_to_smooth_surface(p, c.first_index, c.barycentric, c.position) +
                             clearance_bound(c.position, extent) * c.normal;
    return sample;
}

std::vector<SurfaceSample> sample_surface(const Scene& scene,
                                          const std::vector<std::uint32_t>& primitives,
                                          std::uint32_t count, std::uint64_t seed,
                                          const Context& context) {
    const AreaTable table = make_area_table(scene, primitives);
    if (count == 0 || !(table.total() > 0)) {
        return {};
    }
    const std::size_t per_sample = count < 64 ? 5 : 4;
    const std::vector<SurfacePoint> candidates =
        scatter_points(scene, table, std::size_t{count} * per_sample, false, seed);
    std::vector<SurfacePoint> points;
    for (const std::uint32_t i : eliminate_crowded(candidates, count, table.total(), context)) {
        points.push_back(candidates[i]);
    }
    const std::vector<float> area =
        centre_in_cells(scene, table, std::sqrt(table.total() / count), seed, points, context);
    std::vector<SurfaceSample> samples;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (area[i] > 0) {
            samples.push_back(make_surface_sample(scene, points[i], area[i]));
        }
    }
    sort_into_groups(samples);
    return samples;
}

}  // namespace opaline::bake
