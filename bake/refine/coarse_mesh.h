#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace opaline::bake {

/// A smooth mesh as far as light on it may be interpolated from fewer of its vertices.
struct DenseMesh {
    std::vector<glm::vec3> position;  ///< [m]
    std::vector<glm::vec3> normal;    ///< unit; zero: the vertex stays
    std::vector<std::array<std::uint32_t, 3>> triangle;
};

/// How far vertices may be taken away.
struct CoarseLimits {
    /// Of each vertex [m]: edges of the triangle that it is interpolated in are no longer.
    std::span<const float> spacing;
    /// Of each vertex: bound on normal_error there, in (0, 1).
    double normal_error = 0;
};

/// What a vertex interpolates: vertices that stay, with weights >= 0 that add up to 1, the largest
/// one first. One that stays has itself with weight 1.
struct CoarseMix {
    std::array<std::uint32_t, 3> vertex{};
    std::array<float, 3> weight{1, 0, 0};

    bool stays() const { return weight[0] == 1; }
};

/// The mean square, over suns of all directions, of what the unoccluded irradiance of `normal`
/// differs by from the mean of that of `normals`, relative to that of one receiver: with e(w) =
/// max(0, n.w) - sum_k b_k max(0, n_k.w), integral e^2 dw / (2 pi / 3). Exact: the integral of
/// max(0, a.w) max(0, b.w) over all directions is (2/3) (sin t + (pi - t) cos t), t the angle
/// between a and b, the kernel of [Cho2009] in three dimensions.
double normal_error(glm::vec3 normal, const std::array<glm::vec3, 3>& normals,
                    const std::array<float, 3>& weights);

/// Takes vertices away by half-edge collapses as long as the limits hold at all that were taken,
/// short edges first. Vertices on edges that do not have two triangles stay: borders, creases,
/// seams of normals, and edges of more than two. Triangles never turn over. One mix a vertex. The
/// result depends on the input alone.
std::vector<CoarseMix> coarsen(const DenseMesh& mesh, const CoarseLimits& limits);

}  // namespace opaline::bake
