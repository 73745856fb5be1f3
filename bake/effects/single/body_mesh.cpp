#include "bake/effects/single/body_mesh.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "bake/effects/single/inner_triangles.h"
#include "bake/receivers/spatial_order.h"

namespace opaline::bake {
namespace {

constexpr float kFarthest = std::numeric_limits<float>::infinity();

// Spatial order for locality in memory; the body's triangles stay first.
void sort_in_space(BodyMesh& mesh) {
    const std::vector<std::uint32_t> order = spatial_order(mesh.position);
    std::vector<glm::vec3> position;
    std::vector<std::uint32_t> rank(order.size());
    for (const std::uint32_t v : order) {
        rank[v] = static_cast<std::uint32_t>(position.size());
        position.push_back(mesh.position[v]);
    }
    mesh.position = std::move(position);
    for (glm::uvec3& t : mesh.triangle) {
        t = {rank[t.x], rank[t.y], rank[t.z]};
    }
    const auto middle = mesh.triangle.begin() + mesh.body_triangles;
    const auto before = [](glm::uvec3 a, glm::uvec3 b) {
        return std::min({a.x, a.y, a.z}) < std::min({b.x, b.y, b.z});
    };
    std::stable_sort(mesh.triangle.begin(), middle, before);
    std::stable_sort(middle, mesh.triangle.end(), before);
}

}  // namespace

BodyMesh make_body_mesh(const formats::Scene& scene, const RayScene& rays, std::uint32_t material,
                        const Context& context) {
    BodyMesh mesh;
    const std::vector<std::uint8_t> inner = find_inner_triangles(scene, rays, material, context);
    std::size_t next = 0;
    glm::vec3 low(kFarthest), high(-kFarthest);
    double edges = 0;
    for (const bool body : {true, false}) {
        for (const formats::Primitive& p : scene.primitives) {
            if ((p.material == material) != body) {
                continue;
            }
            const auto base = static_cast<std::uint32_t>(mesh.position.size());
            mesh.position.insert(mesh.position.end(), p.position.begin(), p.position.end());
            for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
                const glm::uvec3 t(p.index[i], p.index[i + 1], p.index[i + 2]);
                if (body && inner[next++] != 0) {
                    continue;
                }
                mesh.triangle.push_back(base + t);
                if (body) {
                    edges += double{glm::distance(p.position[t.x], p.position[t.y])};
                    for (const std::uint32_t v : {t.x, t.y, t.z}) {
                        low = glm::min(low, p.position[v]);
                        high = glm::max(high, p.position[v]);
                    }
                }
            }
        }
        if (body) {
            mesh.body_triangles = static_cast<std::uint32_t>(mesh.triangle.size());
        }
    }
    if (mesh.body_triangles != 0) {
        mesh.centre = 0.5f * low + 0.5f * high;
        mesh.mean_edge = static_cast<float>(edges / mesh.body_triangles);
    }
    sort_in_space(mesh);
    for (glm::vec3& v : mesh.position) {
        v -= mesh.centre;
    }
    for (std::uint32_t t = 0; t < mesh.body_triangles; ++t) {
        for (glm::length_t k = 0; k < 3; ++k) {
            mesh.radius = std::max(mesh.radius, glm::length(mesh.position[mesh.triangle[t][k]]));
        }
    }
    return mesh;
}

}  // namespace opaline::bake
