#include "bake/trace/density/attenuation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

// Sets V to 0 toward cells that a surface hides.
std::uint64_t hide_behind_surfaces(const RayScene& rays, const LightCells& cells,
                                   glm::vec3 position, std::size_t bands, std::span<float> out) {
    std::uint64_t traced = 0;
    for (std::size_t first = 0; first < cells.size(); first += RayPacket::kSize) {
        RayPacket packet = rays_from(position);
        LaneMask lanes{};
        const std::size_t count = std::min<std::size_t>(RayPacket::kSize, cells.size() - first);
        for (std::size_t lane = 0; lane < count; ++lane) {
            packet.dir_x[lane] = cells.x[first + lane];
            packet.dir_y[lane] = cells.y[first + lane];
            packet.dir_z[lane] = cells.z[first + lane];
            packet.tfar[lane] = std::numeric_limits<float>::infinity();
            lanes[lane] = -1;
        }
        rays.occluded(lanes, packet);
        traced += count;
        for (std::size_t lane = 0; lane < count; ++lane) {
            if (packet.tfar[lane] < 0) {
                for (std::size_t band = 0; band < bands; ++band) {
                    out[band * cells.size() + first + lane] = 0;
                }
            }
        }
    }
    return traced;
}

}  // namespace

void gather_transmittance(const DensitySpace& space, const LightCells& cells, glm::vec3 position,
                          std::span<float> out) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::array<float, 3> depth = optical_depth(space, position, cells.direction(i));
        for (std::size_t band = 0; band < space.extinction_bands(); ++band) {
            out[band * cells.size() + i] = std::exp(-depth[band]);
        }
    }
}

std::uint64_t gather_attenuation(const DensitySpace& space, const RayScene& rays,
                                 const LightCells& cells, glm::vec3 position,
                                 std::span<float> out) {
    gather_transmittance(space, cells, position, out);
    return rays.is_empty()
               ? 0
               : hide_behind_surfaces(rays, cells, position, space.extinction_bands(), out);
}

DepthTable make_depth_table(std::size_t points, std::size_t cells, std::size_t bands) {
    DepthTable table;
    table.cells = cells;
    table.bands = bands;
    table.code.resize(points * bands * cells);
    table.most.resize(points * bands);
    return table;
}

void set_depths(DepthTable& table, std::size_t point, std::size_t band,
                std::span<const float> attenuation) {
    std::uint16_t* const code = table.code.data() + (point * table.bands + band) * table.cells;
    table.most[point * table.bands + band] = std::ranges::max(attenuation);
    for (std::size_t i = 0; i < attenuation.size(); ++i) {
        const float depth = attenuation[i] > 0 ? -std::log(attenuation[i]) : DepthTable::kLargest;
        code[i] = static_cast<std::uint16_t>(
            std::lround(std::clamp(depth, 0.0f, DepthTable::kLargest) / DepthTable::kStep));
    }
}

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
    if (m == n) return values;
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
