#include "bake/receivers/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "bake/receivers/centre_in_cells.h"
#include "bake/receivers/point_grid.h"
#include "bake/receivers/surface_points.h"
#include "bake/receivers/vertex_receivers.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

// Removes the most crowded point until `count` are left [Yuksel2015, section 3].
std::vector<std::uint32_t> eliminate(const std::vector<SurfacePoint>& points, std::size_t count,
                                     double area) {
    const double r_max = std::sqrt(area / (2.0 * std::sqrt(3.0) * static_cast<double>(count)));
    const float radius = static_cast<float>(2.0 * r_max);
    const PointGrid grid(points, radius);
    const auto crowding = [radius](float distance) {
        const float x = 1.0f - distance / radius, x2 = x * x, x4 = x2 * x2;
        return static_cast<double>(x4 * x4);
    };
    std::vector<double> weight(points.size(), 0.0);
    std::vector<bool> alive(points.size(), true);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry> heap;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        grid.for_each_near(i, radius, [&](std::uint32_t, float d) { weight[i] += crowding(d); });
        heap.emplace(weight[i], i);
    }
    for (std::size_t left = points.size(); left > count;) {
        const auto [crowd, i] = heap.top();
        heap.pop();
        if (!alive[i]) {
            continue;
        }
        // Weights only fall: an outdated entry is pushed back with its present weight.
        if (crowd != weight[i]) {
            heap.emplace(weight[i], i);
            continue;
        }
        alive[i] = false;
        --left;
        grid.for_each_near(i, radius, [&](std::uint32_t j, float d) {
            if (alive[j]) {
                weight[j] = std::max(0.0, weight[j] - crowding(d));
            }
        });
    }
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (alive[i]) {
            kept.push_back(i);
        }
    }
    return kept;
}

// Where the smooth surface suggested by the vertex normals lies above the facet: the point, moved
// out of each vertex's tangent plane, averaged [Hanika2021].
glm::vec3 lift_to_smooth_surface(const Primitive& p, const SurfacePoint& c) {
    glm::vec3 lift(0);
    for (glm::length_t k = 0; k < 3; ++k) {
        const std::uint32_t v = p.index[c.first_index + static_cast<std::uint32_t>(k)];
        const float below = std::min(0.0f, glm::dot(c.position - p.position[v], p.normal[v]));
        lift -= c.barycentric[k] * below * p.normal[v];
    }
    return lift;
}

SurfaceSample finish(const Scene& scene, const SurfacePoint& c, float area) {
    const Primitive& p = scene.primitives[c.primitive];
    SurfaceSample sample;
    sample.position = c.position;
    sample.geometric_normal = c.normal;
    sample.area = area;
    sample.primitive = c.primitive;
    glm::vec3 normal(0);
    float magnitude = 0;
    for (glm::length_t k = 0; k < 3; ++k) {
        const std::uint32_t v = p.index[c.first_index + static_cast<std::uint32_t>(k)];
        normal += c.barycentric[k] * p.normal[v];
        const glm::vec3 a = glm::abs(p.position[v]);
        magnitude = std::max({magnitude, a.x, a.y, a.z});
    }
    const float length = glm::length(normal);
    sample.normal = length > 0 && glm::dot(normal, c.normal) > 0 ? normal / length : c.normal;
    sample.receiver.normal = sample.normal;
    sample.receiver.origin =
        c.position + lift_to_smooth_surface(p, c) + intersection_error_bound(magnitude) * c.normal;
    return sample;
}

}  // namespace

std::vector<SurfaceSample> sample_surface(const Scene& scene,
                                          const std::vector<std::uint32_t>& primitives,
                                          std::uint32_t count, std::uint64_t seed) {
    const AreaTable table = make_area_table(scene, primitives);
    if (count == 0 || !(table.total() > 0)) {
        return {};
    }
    const std::size_t per_sample = count < 64 ? 5 : 4;
    const std::vector<SurfacePoint> candidates =
        scatter_points(scene, table, std::size_t{count} * per_sample, false, seed);
    std::vector<SurfacePoint> points;
    for (const std::uint32_t i : eliminate(candidates, count, table.total())) {
        points.push_back(candidates[i]);
    }
    const std::vector<float> area =
        centre_in_cells(scene, table, std::sqrt(table.total() / count), seed, points);
    std::vector<SurfaceSample> samples;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (area[i] > 0) {
            samples.push_back(finish(scene, points[i], area[i]));
        }
    }
    return samples;
}

}  // namespace opaline::bake
