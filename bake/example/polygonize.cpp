#include "bake/example/polygonize.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace opaline::bake {
namespace {

constexpr std::size_t kBlock = 8;  ///< grid nodes along a block's edge

/// Field values on the nodes of a regular grid, x running fastest.
struct Grid {
    glm::dvec3 origin{0.0};
    double cell = 0.0;
    std::size_t nx = 0, ny = 0, nz = 0;  ///< nodes
    std::vector<double> value;

    std::size_t at(std::size_t x, std::size_t y, std::size_t z) const {
        return (z * ny + y) * nx + x;
    }
    glm::dvec3 point(double x, double y, double z) const {
        return origin + cell * glm::dvec3(x, y, z);
    }
};

/// Samples one block of nodes; far from the surface the value at the centre stands for all, since
/// only its sign matters there.
void sample_block(const Field& field, Grid& grid, std::size_t bx, std::size_t by, std::size_t bz) {
    const std::size_t x1 = std::min(bx + kBlock, grid.nx), y1 = std::min(by + kBlock, grid.ny),
                      z1 = std::min(bz + kBlock, grid.nz);
    const double half = double{kBlock - 1} / 2.0;
    const double center =
        field(grid.point(static_cast<double>(bx) + half, static_cast<double>(by) + half,
                         static_cast<double>(bz) + half));
    // Twice the half diagonal, as the field only approximates a distance.
    const bool far = std::abs(center) > 2.0 * std::sqrt(3.0) * half * grid.cell;
    for (std::size_t z = bz; z < z1; ++z) {
        for (std::size_t y = by; y < y1; ++y) {
            for (std::size_t x = bx; x < x1; ++x) {
                grid.value[grid.at(x, y, z)] =
                    far ? center
                        : field(grid.point(static_cast<double>(x), static_cast<double>(y),
                                           static_cast<double>(z)));
            }
        }
    }
}

Grid sample_grid(const Field& field, const Box& bounds, double cell) {
    const auto nodes = [&](double low, double high) {
        return static_cast<std::size_t>(std::ceil((high - low) / cell)) + 1;
    };
    Grid grid;
    grid.origin = bounds.low;
    grid.cell = cell;
    grid.nx = nodes(bounds.low.x, bounds.high.x);
    grid.ny = nodes(bounds.low.y, bounds.high.y);
    grid.nz = nodes(bounds.low.z, bounds.high.z);
    grid.value.resize(grid.nx * grid.ny * grid.nz);
    const auto blocks = [](std::size_t count) { return (count + kBlock - 1) / kBlock; };
    const std::size_t mx = blocks(grid.nx), my = blocks(grid.ny), mz = blocks(grid.nz);
    tbb::parallel_for(std::size_t{0}, mx * my * mz, [&](std::size_t i) {
        sample_block(field, grid, i % mx * kBlock, i / mx % my * kBlock, i / (mx * my) * kBlock);
    });
    return grid;
}

/// Mean of the points where the surface crosses the twelve edges of a cell, in cell coordinates;
/// false if it crosses none.
bool cell_vertex(const double (&corner)[8], glm::dvec3& vertex) {
    glm::dvec3 sum(0.0);
    int crossings = 0;
    for (unsigned a = 0; a < 8; ++a) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            const unsigned b = a | 1u << axis;
            if (a == b || (corner[a] < 0.0) == (corner[b] < 0.0)) continue;
            glm::dvec3 point(a & 1u, a >> 1 & 1u, a >> 2 & 1u);
            point[static_cast<int>(axis)] = corner[a] / (corner[a] - corner[b]);
            sum += point;
            ++crossings;
        }
    }
    if (crossings == 0) return false;
    vertex = sum / static_cast<double>(crossings);
    return true;
}

/// Two triangles along the shorter diagonal of the quad a b c d, counter-clockwise from outside.
void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              std::uint32_t d) {
    const auto& p = mesh.position;
    if (glm::distance(p[a], p[c]) <= glm::distance(p[b], p[d])) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
    }
}

}  // namespace

TriangleMesh polygonize(const Field& field, const Box& bounds, double cell) {
    const Grid grid = sample_grid(field, bounds, cell);
    TriangleMesh mesh;
    constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> vertex_of(grid.value.size(), kNoVertex);
    const std::size_t step[3] = {1, grid.nx, grid.nx * grid.ny};
    for (std::size_t z = 0; z + 1 < grid.nz; ++z) {
        for (std::size_t y = 0; y + 1 < grid.ny; ++y) {
            for (std::size_t x = 0; x + 1 < grid.nx; ++x) {
                const std::size_t node = grid.at(x, y, z);
                double corner[8];
                for (unsigned i = 0; i < 8; ++i) {
                    corner[i] = grid.value[node + (i & 1u) * step[0] + (i >> 1 & 1u) * step[1] +
                                           (i >> 2 & 1u) * step[2]];
                }
                glm::dvec3 vertex;
                if (!cell_vertex(corner, vertex)) continue;
                vertex_of[node] = static_cast<std::uint32_t>(mesh.position.size());
                mesh.position.push_back(grid.point(static_cast<double>(x) + vertex.x,
                                                   static_cast<double>(y) + vertex.y,
                                                   static_cast<double>(z) + vertex.z));
            }
        }
    }
    for (std::size_t z = 1; z + 1 < grid.nz; ++z) {
        for (std::size_t y = 1; y + 1 < grid.ny; ++y) {
            for (std::size_t x = 1; x + 1 < grid.nx; ++x) {
                const std::size_t node = grid.at(x, y, z);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const bool inside = grid.value[node] < 0.0;
                    if (inside == (grid.value[node + step[axis]] < 0.0)) continue;
                    const std::size_t u = step[(axis + 1) % 3], v = step[(axis + 2) % 3];
                    const std::uint32_t a = vertex_of[node - u - v], b = vertex_of[node - v],
                                        c = vertex_of[node], d = vertex_of[node - u];
                    // Seen against the axis, a b c d runs counter-clockwise.
                    if (inside) {
                        add_quad(mesh, a, b, c, d);
                    } else {
                        add_quad(mesh, d, c, b, a);
                    }
                }
            }
        }
    }
    return mesh;
}

}  // namespace opaline::bake
