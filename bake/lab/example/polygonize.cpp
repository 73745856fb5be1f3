#include "bake/lab/example/solid_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>

#include "bake/base/parallel_indices.h"

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

/// Samples one block of nodes. Far from the surface the value at the centre is used for all,
/// because only its sign matters.
void sample_block(const ScalarField& field, Grid& grid, std::size_t bx, std::size_t by,
                  std::size_t bz) {
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

Grid sample_grid(const ScalarField& field, const Box& bounds, double cell) {
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
    for_each_index(mx * my * mz, [&](std::size_t i) {
        sample_block(field, grid, i % mx * kBlock, i / mx % my * kBlock, i / (mx * my) * kBlock);
    });
    return grid;
}

// Corner i of a cell lies at (i & 1, i >> 1 & 1, i >> 2 & 1); the cell edge from there along an
// axis is number 3 i + axis.
constexpr std::size_t kCellEdges = 24;

/// The corners of a cell's faces, counter-clockwise seen from outside the cell.
constexpr unsigned kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

std::size_t cell_edge(unsigned a, unsigned b) {
    const unsigned axis = (a ^ b) >> 1;  // 1, 2, 4 become 0, 1, 2
    return 3 * std::min(a, b) + axis;
}

/// For each crossed edge of a cell, the next edge of the surface's outline, or kCellEdges if the
/// edge is not crossed. True if some face is ambiguous.
bool link_outline(const bool (&inside)[8], std::size_t (&next)[kCellEdges]) {
    std::fill(std::begin(next), std::end(next), kCellEdges);
    bool ambiguous = false;
    for (const auto& face : kFaces) {
        for (unsigned k = 0; k < 4; ++k) {
            // Around the face, the outline runs from an entry into the solid to the preceding exit.
            // Opposite inside corners are thereby joined, and cells that share the face agree.
            if (inside[face[k]] || !inside[face[(k + 1) % 4]]) continue;
            unsigned left = (k + 3) % 4;
            while (!inside[face[left]] || inside[face[(left + 1) % 4]]) {
                left = (left + 3) % 4;
            }
            next[cell_edge(face[k], face[(k + 1) % 4])] =
                cell_edge(face[left], face[(left + 1) % 4]);
        }
        ambiguous =
            ambiguous || (inside[face[0]] == inside[face[2]] &&
                          inside[face[1]] == inside[face[3]] && inside[face[0]] != inside[face[1]]);
    }
    return ambiguous;
}

/// Fills one outline. Anything but a plain triangle or quad gets a vertex in its middle, since a
/// diagonal might coincide with one of another outline.
void fill_outline(const std::vector<std::uint32_t>& outline, bool ambiguous, TriangleMesh& mesh) {
    const auto& p = mesh.position;
    if (outline.size() == 3) {
        mesh.triangles.push_back({outline[0], outline[1], outline[2]});
        return;
    }
    if (outline.size() == 4 && !ambiguous) {
        const auto [a, b, c, d] = std::array{outline[0], outline[1], outline[2], outline[3]};
        if (glm::distance(p[a], p[c]) <= glm::distance(p[b], p[d])) {
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
        } else {
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
        }
        return;
    }
    glm::dvec3 sum(0.0);
    for (const std::uint32_t v : outline) {
        sum += p[v];
    }
    const auto middle = static_cast<std::uint32_t>(p.size());
    mesh.position.push_back(sum / static_cast<double>(outline.size()));
    for (std::size_t i = 0; i < outline.size(); ++i) {
        mesh.triangles.push_back({middle, outline[i], outline[(i + 1) % outline.size()]});
    }
}

/// Adds the part of the surface inside one cell; `vertex_of` numbers the crossed grid edges.
void cut_cell(const Grid& grid, std::size_t node, const std::vector<std::uint32_t>& vertex_of,
              TriangleMesh& mesh) {
    std::size_t corner[8];
    bool inside[8];
    for (unsigned i = 0; i < 8; ++i) {
        corner[i] = node + grid.at(i & 1u, i >> 1 & 1u, i >> 2 & 1u);
        inside[i] = grid.value[corner[i]] < 0.0;
    }
    if (std::all_of(inside, inside + 8, [&](bool in) { return in == inside[0]; })) return;
    std::size_t next[kCellEdges];
    const bool ambiguous = link_outline(inside, next);
    for (std::size_t start = 0; start < kCellEdges; ++start) {
        std::vector<std::uint32_t> outline;
        for (std::size_t edge = start; next[edge] != kCellEdges;) {
            outline.push_back(vertex_of[3 * corner[edge / 3] + edge % 3]);
            edge = std::exchange(next[edge], kCellEdges);
        }
        if (!outline.empty()) fill_outline(outline, ambiguous, mesh);
    }
}

/// Calls visit(x, y, z) for the low corner of every cell.
template <class Visit>
void for_each_cell(const Grid& grid, const Visit& visit) {
    for (std::size_t z = 0; z + 1 < grid.nz; ++z) {
        for (std::size_t y = 0; y + 1 < grid.ny; ++y) {
            for (std::size_t x = 0; x + 1 < grid.nx; ++x) {
                visit(x, y, z);
            }
        }
    }
}

}  // namespace

TriangleMesh polygonize(const ScalarField& field, const Box& bounds, double cell) {
    const Grid grid = sample_grid(field, bounds, cell);
    const std::size_t step[3] = {1, grid.nx, grid.nx * grid.ny};
    TriangleMesh mesh;
    std::vector<std::uint32_t> vertex_of(3 * grid.value.size());
    for_each_cell(grid, [&](std::size_t x, std::size_t y, std::size_t z) {
        const std::size_t node = grid.at(x, y, z);
        const double here = grid.value[node];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double there = grid.value[node + step[axis]];
            if ((here < 0.0) == (there < 0.0)) continue;
            glm::dvec3 p(x, y, z);
            // Keep a distance from the grid's nodes, where vertices of several edges would
            // coincide.
            p[static_cast<int>(axis)] += std::clamp(here / (here - there), 0.02, 0.98);
            vertex_of[3 * node + axis] = static_cast<std::uint32_t>(mesh.position.size());
            mesh.position.push_back(grid.point(p.x, p.y, p.z));
        }
    });
    for_each_cell(grid, [&](std::size_t x, std::size_t y, std::size_t z) {
        cut_cell(grid, grid.at(x, y, z), vertex_of, mesh);
    });
    return mesh;
}

}  // namespace opaline::bake
