#include "bake/receivers/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <unordered_map>

#include "bake/base/rng.h"
#include "bake/receivers/vertex_receivers.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

struct Triangle {
    std::uint32_t primitive = 0;
    std::uint32_t first_index = 0;
};

struct Candidate {
    Triangle triangle;
    glm::vec3 barycentric;
    glm::vec3 position, normal;
};

struct AreaTable {
    std::vector<Triangle> triangle;
    std::vector<double> cumulative;  // area of all triangles up to and including this one [m^2]
    double total() const { return cumulative.empty() ? 0.0 : cumulative.back(); }
};

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

glm::vec3 facet_normal(const Primitive& p, std::uint32_t i) {
    const glm::dvec3 a = p.position[p.index[i]];
    return glm::vec3(glm::normalize(glm::cross(glm::dvec3(p.position[p.index[i + 1]]) - a,
                                               glm::dvec3(p.position[p.index[i + 2]]) - a)));
}

std::vector<Candidate> scatter(const Scene& scene, const AreaTable& table, std::size_t count,
                               std::uint64_t seed) {
    std::vector<Candidate> candidates(count);
    std::size_t at = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto u = random_uniform(seed, RandomStage::surface_samples, k);
        const double target = table.total() * (static_cast<double>(k) + static_cast<double>(u[0])) /
                              static_cast<double>(count);
        while (at + 1 < table.cumulative.size() && table.cumulative[at] <= target) {
            ++at;
        }
        // Uniform barycentric coordinates by the square-root warp.
        const float root = std::sqrt(u[1]);
        Candidate& c = candidates[k];
        c.triangle = table.triangle[at];
        c.barycentric = {1.0f - root, root * (1.0f - u[2]), root * u[2]};
        const Primitive& p = scene.primitives[c.triangle.primitive];
        const std::uint32_t i = c.triangle.first_index;
        c.position = c.barycentric.x * p.position[p.index[i]] +
                     c.barycentric.y * p.position[p.index[i + 1]] +
                     c.barycentric.z * p.position[p.index[i + 2]];
        c.normal = facet_normal(p, i);
    }
    return candidates;
}

// Normals at more than 120 degrees belong to different sides of a sheet; those of a box's edge do
// not.
constexpr float kOpposed = -0.5f;

// Points in cubic cells of the search radius.
class Grid {
  public:
    Grid(const std::vector<Candidate>& points, float cell) : points_(points), cell_(cell) {
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            cells_[key(coordinates(points[i].position))].push_back(i);
        }
    }

    template <class Visit>
    void for_each_near(std::uint32_t i, float radius, Visit&& visit) const {
        const glm::ivec3 centre = coordinates(points_[i].position);
        for (int dz = -1; dz <= 1; ++dz) {
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx) {
                    const auto cell = cells_.find(key(centre + glm::ivec3(dx, dy, dz)));
                    if (cell == cells_.end()) {
                        continue;
                    }
                    for (const std::uint32_t j : cell->second) {
                        const float d = glm::distance(points_[i].position, points_[j].position);
                        if (j != i && d < radius &&
                            glm::dot(points_[i].normal, points_[j].normal) > kOpposed) {
                            visit(j, d);
                        }
                    }
                }
            }
        }
    }

  private:
    glm::ivec3 coordinates(glm::vec3 p) const { return glm::ivec3(glm::floor(p / cell_)); }
    static std::uint64_t key(glm::ivec3 c) {
        const auto part = [](int x) { return static_cast<std::uint64_t>(x) & 0x1fffffu; };
        return part(c.x) | part(c.y) << 21 | part(c.z) << 42;
    }

    const std::vector<Candidate>& points_;
    float cell_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

// Removes the most crowded point until `count` are left [Yuksel2015, section 3].
std::vector<std::uint32_t> eliminate(const std::vector<Candidate>& points, std::size_t count,
                                     double area) {
    const double r_max = std::sqrt(area / (2.0 * std::sqrt(3.0) * static_cast<double>(count)));
    const float radius = static_cast<float>(2.0 * r_max);
    const Grid grid(points, radius);
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
glm::vec3 lift_to_smooth_surface(const Primitive& p, const Candidate& c) {
    glm::vec3 lift(0);
    for (glm::length_t k = 0; k < 3; ++k) {
        const std::uint32_t v = p.index[c.triangle.first_index + static_cast<std::uint32_t>(k)];
        const float below = std::min(0.0f, glm::dot(c.position - p.position[v], p.normal[v]));
        lift -= c.barycentric[k] * below * p.normal[v];
    }
    return lift;
}

SurfaceSample finish(const Scene& scene, const Candidate& c, float area) {
    const Primitive& p = scene.primitives[c.triangle.primitive];
    SurfaceSample sample;
    sample.position = c.position;
    sample.geometric_normal = c.normal;
    sample.area = area;
    sample.primitive = c.triangle.primitive;
    glm::vec3 normal(0);
    float magnitude = 0;
    for (glm::length_t k = 0; k < 3; ++k) {
        const std::uint32_t v = p.index[c.triangle.first_index + static_cast<std::uint32_t>(k)];
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
    const std::vector<Candidate> candidates =
        scatter(scene, table, std::size_t{count} * per_sample, seed);
    const float area = static_cast<float>(table.total() / count);
    std::vector<SurfaceSample> samples;
    samples.reserve(count);
    for (const std::uint32_t i : eliminate(candidates, count, table.total())) {
        samples.push_back(finish(scene, candidates[i], area));
    }
    return samples;
}

}  // namespace opaline::bake
