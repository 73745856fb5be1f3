#include "bake/volumes/light_cells.h"

#include <algorithm>

#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {

LightCells make_light_cells(std::uint32_t n) {
    LightCells cells;
    cells.n = n;
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::uint32_t row = 0; row < n; ++row) {
            for (std::uint32_t column = 0; column < n; ++column) {
                const formats::Vec3 w = formats::texel_direction(n, face, row, column);
                cells.x.push_back(w.x);
                cells.y.push_back(w.y);
                cells.z.push_back(w.z);
            }
        }
    }
    return cells;
}

std::vector<float> reduce_cells(const std::vector<float>& values, std::uint32_t fine,
                                std::uint32_t coarse) {
    const std::uint32_t block = fine / coarse;
    std::vector<float> reduced(formats::cubemap_texels(coarse), 0.0f);
    const float share = 1.0f / static_cast<float>(block * block);
    for (std::size_t i = 0; i < values.size(); ++i) {
        reduced[coarser_texel(i, fine, coarse)] += share * values[i];
    }
    return reduced;
}

void haar_inverse_cube(std::span<float> cube, std::uint32_t n) {
    const std::size_t size = std::size_t{n} * n;
    std::vector<float> scratch(size);
    for (std::size_t face = 0; face < formats::kCubeFaces; ++face) {
        formats::haar_inverse(cube.subspan(face * size, size), n, scratch);
    }
}

std::vector<float> transform_cells(std::vector<float> values, std::uint32_t m, std::uint32_t n) {
    // Each level on which all four values of a block coincide doubles them.
    const float scale = static_cast<float>(n / m);
    formats::haar_forward_cube(std::span<float>(values), m);
    if (m == n) {
        return values;
    }
    std::vector<float> fine(formats::cubemap_texels(n), 0.0f);
    for (std::size_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::size_t row = 0; row < m; ++row) {
            for (std::size_t column = 0; column < m; ++column) {
                fine[(face * n + row) * n + column] = scale * values[(face * m + row) * m + column];
            }
        }
    }
    return fine;
}

}  // namespace opaline::bake
