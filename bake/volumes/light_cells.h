#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace opaline::bake {

/// Directions of distant light: through the centres of a cube map's texels, in its order.
struct LightCells {
    std::uint32_t n = 0;  ///< texels along an edge of a face
    std::vector<float> x, y, z;

    std::size_t size() const { return x.size(); }
    glm::vec3 direction(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// `n`: power of two, 2 or more.
LightCells make_light_cells(std::uint32_t n);

/// Mean of each 2^k x 2^k block of texels: from `fine` texels along an edge to `coarse`, powers of
/// two with coarse <= fine.
std::vector<float> reduce_cells(const std::vector<float>& values, std::uint32_t fine,
                                std::uint32_t coarse);

/// The texel of a cube map of m x m texels that holds texel i of one of n x n, a multiple of m;
/// maps of several bands follow each other in both.
inline std::size_t coarser_texel(std::size_t i, std::size_t n, std::size_t m) {
    const std::size_t column = i % n, row = i / n % n, face = i / n / n, block = n / m;
    return (face * m + row / block) * m + column / block;
}

/// Texel values from Haar coefficients, in place: 6 n n.
void haar_inverse_cube(std::span<float> cube, std::uint32_t n);

/// Haar coefficients of a cube map of n x n texels, made of the texel values of one of m x m, m <=
/// n: every value covers (n / m)^2 texels. `values`: 6 m m; result: 6 n n.
std::vector<float> transform_cells(std::vector<float> values, std::uint32_t m, std::uint32_t n);

}  // namespace opaline::bake
