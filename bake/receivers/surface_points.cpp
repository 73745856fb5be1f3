#include "bake/receivers/surface_points.h"

#include <cmath>

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

double fraction(double x) {
    return x - std::floor(x);
}

}  // namespace

AreaTable make_area_table(const Scene& scene, const std::vector<std::uint32_t>& primitives) {
    AreaTable table;
    double sum = 0;
    for (const std::uint32_t index : primitives) {
        const Primitive& p = scene.primitives[index];
        for (std::uint32_t i = 0; i + 2 < p.index.size(); i += 3) {
            const glm::dvec3 a = p.position[p.index[i]];
            const glm::dvec3 b = p.position[p.index[i + 1]];
            const glm::dvec3 c = p.position[p.index[i + 2]];
            const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
            if (area > 0) {
                sum += area;
                table.triangle.push_back({index, i});
                table.cumulative.push_back(sum);
            }
        }
    }
    return table;
}

SurfacePoint make_surface_point(const Scene& scene, const AreaTable::Triangle& triangle,
                                glm::vec3 barycentric) {
    const Primitive& p = scene.primitives[triangle.primitive];
    const glm::dvec3 a = p.position[p.index[triangle.first_index]];
    const glm::dvec3 b = p.position[p.index[triangle.first_index + 1]];
    const glm::dvec3 c = p.position[p.index[triangle.first_index + 2]];
    SurfacePoint point;
    point.primitive = triangle.primitive;
    point.first_index = triangle.first_index;
    point.barycentric = barycentric;
    point.position = glm::dvec3(barycentric.x) * a + glm::dvec3(barycentric.y) * b +
                     glm::dvec3(barycentric.z) * c;
    point.normal = glm::normalize(glm::cross(b - a, c - a));
    return point;
}

std::vector<SurfacePoint> scatter_points(const Scene& scene, const AreaTable& table,
                                         std::size_t count, bool even, std::uint64_t seed,
                                         RandomStage stage) {
    std::vector<SurfacePoint> points;
    points.reserve(count);
    std::size_t at = 0, first_in_triangle = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto u = random_uniform(seed, stage, k, even ? 1 : 0);
        const double target = table.total() * (static_cast<double>(k) + static_cast<double>(u[0])) /
                              static_cast<double>(count);
        while (at + 1 < table.cumulative.size() && table.cumulative[at] <= target) {
            ++at;
            first_in_triangle = k;
        }
        if (!even) {
            // Uniform barycentric coordinates by the square-root warp.
            const float root = std::sqrt(u[1]);
            points.push_back(make_surface_point(scene, table.triangle[at],
                                                {1.0f - root, root * (1.0f - u[2]), root * u[2]}));
            continue;
        }
        // The additive recurrence of the plastic number fills a square evenly [Roberts2018]; the
        // upper half is folded onto the lower. Each triangle has its own starting point.
        const auto shift = random_uniform(seed, stage, at, 2);
        const auto i = static_cast<double>(k - first_in_triangle);
        double v = fraction(static_cast<double>(shift[0]) + i * 0.7548776662466927);
        double w = fraction(static_cast<double>(shift[1]) + i * 0.5698402909980532);
        if (v + w > 1) {
            v = 1 - v;
            w = 1 - w;
        }
        points.push_back(make_surface_point(scene, table.triangle[at], {1 - v - w, v, w}));
    }
    return points;
}

}  // namespace opaline::bake
