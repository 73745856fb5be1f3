#include "formats/gltf/smooth_normals.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace opaline::formats::gltf {

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;

/// OpenMesh writes to stderr about every face that is not manifold; we handle those ourselves.
class QuietOpenMesh {
  public:
    QuietOpenMesh() : was_enabled_(omerr().is_enabled()) { omerr().disable(); }
    ~QuietOpenMesh() {
        if (was_enabled_) omerr().enable();
    }
    QuietOpenMesh(const QuietOpenMesh&) = delete;
    QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;

  private:
    bool was_enabled_;
};

/// For each vertex the first vertex at its position.
std::vector<std::uint32_t> weld(std::span<const glm::vec3> position) {
    std::vector<std::uint32_t> order(position.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
        const glm::vec3 p = position[a], q = position[b];
        if (p.x != q.x) return p.x < q.x;
        if (p.y != q.y) return p.y < q.y;
        if (p.z != q.z) return p.z < q.z;
        return a < b;
    };
    std::sort(order.begin(), order.end(), less);
    std::vector<std::uint32_t> first(position.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && position[order[i]] == position[order[i - 1]];
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

OpenMesh::Vec3d to_openmesh(glm::vec3 p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

bool is_direction(glm::dvec3 sum, double weight) {
    // Angles sum to `weight`; below this share the directions cancel up to rounding.
    return glm::length(sum) > 1e-6 * weight && weight > 0.0;
}

}  // namespace

std::vector<glm::vec3> smooth_normals(std::span<const glm::vec3> position,
                                      std::span<const std::uint32_t> index) {
    const QuietOpenMesh quiet;
    const std::vector<std::uint32_t> first = weld(position);

    // Non-manifold faces get vertices of their own. Their geometry is unchanged, and below only
    // sums over `first` matter.
    TriMesh mesh;
    std::vector<TriMesh::VertexHandle> shared(position.size());
    struct Corners {
        TriMesh::FaceHandle face;
        std::array<std::uint32_t, 3> vertex;  // original numbers
    };
    std::vector<Corners> faces;
    faces.reserve(index.size() / 3);
    for (std::size_t t = 0; t + 2 < index.size(); t += 3) {
        const std::array<std::uint32_t, 3> corner = {index[t], index[t + 1], index[t + 2]};
        const auto a = first[corner[0]], b = first[corner[1]], c = first[corner[2]];
        if (a == b || b == c || c == a) {
            continue;
        }
        for (const auto vertex : {a, b, c}) {
            if (!shared[vertex].is_valid()) {
                shared[vertex] = mesh.add_vertex(to_openmesh(position[vertex]));
            }
        }
        auto face = mesh.add_face(shared[a], shared[b], shared[c]);
        if (!face.is_valid()) {
            face = mesh.add_face(mesh.add_vertex(to_openmesh(position[a])),
                                 mesh.add_vertex(to_openmesh(position[b])),
                                 mesh.add_vertex(to_openmesh(position[c])));
        }
        faces.push_back({face, corner});
    }

    std::vector<glm::dvec3> welded(position.size(), glm::dvec3(0.0)), own = welded;
    std::vector<double> welded_weight(position.size(), 0.0), own_weight = welded_weight;
    for (const Corners& corners : faces) {
        const auto n = mesh.calc_face_normal(corners.face);
        const glm::dvec3 normal(n[0], n[1], n[2]);
        if (!(glm::dot(normal, normal) > 0.5)) {
            continue;  // no area, no direction
        }
        for (const auto halfedge : mesh.fh_range(corners.face)) {
            const auto at = mesh.point(mesh.to_vertex_handle(halfedge));
            const double angle = mesh.calc_sector_angle(halfedge);
            if (!std::isfinite(angle)) {
                continue;
            }
            for (const std::uint32_t vertex : corners.vertex) {
                if (to_openmesh(position[first[vertex]]) == at) {
                    welded[first[vertex]] += angle * normal;
                    welded_weight[first[vertex]] += angle;
                    own[vertex] += angle * normal;
                    own_weight[vertex] += angle;
                }
            }
        }
    }

    std::vector<glm::vec3> normals(position.size(), glm::vec3(0.0f));
    for (std::size_t v = 0; v < position.size(); ++v) {
        if (is_direction(welded[first[v]], welded_weight[first[v]])) {
            normals[v] = glm::vec3(glm::normalize(welded[first[v]]));
        } else if (is_direction(own[v], own_weight[v])) {
            normals[v] = glm::vec3(glm::normalize(own[v]));
        }
    }
    return normals;
}

}  // namespace opaline::formats::gltf
