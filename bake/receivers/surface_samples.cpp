#include "bake/receivers/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "bake/receivers/centre_in_cells.h"
#include "bake/receivers/eliminate_crowded.h"
#include "bake/receivers/kd_order.h"
#include "bake/receivers/surface_points.h"
#include "bake/receivers/vertex_receivers.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

// The offset from the facet to the smooth surface [Hanika2021]: the mean offset to the vertices'
// tangent planes, counting those that the point lies below.
glm::vec3 lift_to_smooth_surface(const Primitive& p, const SurfacePoint& c) {
    glm::vec3 lift(0);
    for (glm::length_t k = 0; k < 3; ++k) {
        const std::uint32_t v = p.index[c.first_index + static_cast<std::uint32_t>(k)];
        const float below = std::min(0.0f, glm::dot(c.position - p.position[v], p.normal[v]));
        lift -= c.barycentric[k] * below * p.normal[v];
    }
    return lift;
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
    sample.receiver.origin =
        c.position + lift_to_smooth_surface(p, c) + clearance_bound(c.position, extent) * c.normal;
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
