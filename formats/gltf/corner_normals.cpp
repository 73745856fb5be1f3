#include "formats/gltf/corner_normals.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "formats/disjoint_sets.h"

namespace opaline::formats::gltf {

namespace {

/// For each vertex the first vertex at its position.
std::vector<std::uint32_t> weld(std::span<const glm::vec3> position) {
    std::vector<std::uint32_t> order(position.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
        const glm::vec3 p = position[a], q = position[b];
        return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
    };
    std::sort(order.begin(), order.end(), less);
    std::vector<std::uint32_t> first(position.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && position[order[i]] == position[order[i - 1]];
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

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

double angle_at(glm::dvec3 a, glm::dvec3 b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Triangles by the number of their first corner, their corners by place: the number of the first
/// vertex at the position.
struct Faces {
    std::vector<std::uint32_t> place;  ///< of each corner
    std::vector<glm::dvec3> normal;    ///< of each triangle; {0,0,0}: no area

    std::uint32_t corner_at(std::uint32_t triangle, std::uint32_t where) const {
        return triangle + (place[triangle] == where ? 0u : place[triangle + 1] == where ? 1u : 2u);
    }
};

/// Joins the corners of triangles that share an edge and differ by less than an angle. OpenMesh
/// refuses triangles that make it no manifold; those meet each other in the next round.
void join_smooth_corners(const Faces& faces, std::size_t places, double least_cosine,
                         DisjointSets& sets) {
    constexpr int kRounds = 8;  // then, more than so many triangles meet at one edge or point
    const QuietOpenMesh quiet;
    std::vector<std::uint32_t> left;
    for (std::uint32_t t = 0; t < faces.place.size(); t += 3) {
        if (faces.normal[t / 3] != glm::dvec3(0.0)) {
            left.push_back(t);
        }
    }
    const auto join = [&](std::uint32_t a, std::uint32_t b, std::uint32_t p, std::uint32_t q) {
        if (glm::dot(faces.normal[a / 3], faces.normal[b / 3]) > least_cosine) {
            sets.join(faces.corner_at(a, p), faces.corner_at(b, p));
            sets.join(faces.corner_at(a, q), faces.corner_at(b, q));
        }
    };
    for (int round = 0; round < kRounds && !left.empty(); ++round) {
        TriMesh mesh;
        std::vector<TriMesh::VertexHandle> vertex(places);
        std::vector<std::uint32_t> place, taken, refused;  // by number of vertex, of face; the rest
        for (const std::uint32_t t : left) {
            for (std::size_t k = 0; k < 3; ++k) {
                TriMesh::VertexHandle& at = vertex[faces.place[t + k]];
                if (!at.is_valid()) {
                    at = mesh.add_vertex({});  // only who meets whom matters
                    place.push_back(faces.place[t + k]);
                }
            }
            const bool is_taken = mesh.add_face(vertex[faces.place[t]], vertex[faces.place[t + 1]],
                                                vertex[faces.place[t + 2]])
                                      .is_valid();
            (is_taken ? taken : refused).push_back(t);
        }
        const auto triangle = [&](TriMesh::HalfedgeHandle side) {
            return taken[static_cast<std::size_t>(mesh.face_handle(side).idx())];
        };
        const auto place_of = [&](TriMesh::VertexHandle v) {
            return place[static_cast<std::size_t>(v.idx())];
        };
        for (const auto edge : mesh.edges()) {
            const auto side = mesh.halfedge_handle(edge, 0), other = mesh.halfedge_handle(edge, 1);
            if (!mesh.is_boundary(side) && !mesh.is_boundary(other)) {
                join(triangle(side), triangle(other), place_of(mesh.from_vertex_handle(side)),
                     place_of(mesh.to_vertex_handle(side)));
            }
        }
        for (const std::uint32_t t : refused) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t p = faces.place[t + k], q = faces.place[t + (k + 1) % 3];
                const auto found = mesh.find_halfedge(vertex[p], vertex[q]);
                if (!found.is_valid()) continue;
                const TriMesh::HalfedgeHandle side = found;
                for (const auto at : {side, mesh.opposite_halfedge_handle(side)}) {
                    if (!mesh.is_boundary(at)) {
                        join(t, triangle(at), p, q);
                    }
                }
            }
        }
        left = std::move(refused);
    }
}

}  // namespace

CornerNormals corner_normals(std::span<const glm::vec3> position,
                             std::span<const std::uint32_t> index, double most_angle) {
    constexpr double kFlat = 1e-3;  // [rad]
    const std::vector<std::uint32_t> welded = weld(position);
    const std::size_t count = index.size() / 3 * 3;
    Faces faces{std::vector<std::uint32_t>(count), std::vector<glm::dvec3>(count / 3)};
    for (std::size_t t = 0; t < count; t += 3) {
        const glm::dvec3 a(position[index[t]]), b(position[index[t + 1]]),
            c(position[index[t + 2]]);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double length = glm::length(normal);
        faces.normal[t / 3] = length > 0 ? normal / length : glm::dvec3(0.0);
        for (std::size_t k = 0; k < 3; ++k) {
            faces.place[t + k] = welded[index[t + k]];
        }
    }
    DisjointSets sets(count);
    join_smooth_corners(faces, position.size(), std::cos(std::max(most_angle, kFlat)), sets);

    const std::vector<glm::dvec3>& face = faces.normal;
    std::vector<glm::dvec3> sum(count, glm::dvec3(0.0));
    CornerNormals corners{std::vector<glm::vec3>(count, glm::vec3(0.0f)),
                          std::vector<std::uint32_t>(count)};
    for (std::uint32_t c = 0; c < count; ++c) {
        corners.group[c] = sets.find(c);
        const std::uint32_t first = c / 3 * 3;
        const glm::dvec3 at(position[index[c]]);
        sum[corners.group[c]] += angle_at(glm::dvec3(position[index[first + (c + 1) % 3]]) - at,
                                          glm::dvec3(position[index[first + (c + 2) % 3]]) - at) *
                                 face[c / 3];
    }
    for (std::size_t c = 0; c < count; ++c) {
        // Angles at a position add up to some 2 pi; what is left of faces that cancel is rounding.
        const glm::dvec3 mean = sum[corners.group[c]];
        const bool cancels = !(glm::length(mean) > 1e-9);
        if (face[c / 3] != glm::dvec3(0.0)) {
            corners.normal[c] = glm::vec3(cancels ? face[c / 3] : glm::normalize(mean));
        }
        if (cancels) {
            corners.group[c] = static_cast<std::uint32_t>(c);
        }
    }
    return corners;
}

}  // namespace opaline::formats::gltf
