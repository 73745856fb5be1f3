#include "bake/lab/example/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace opaline::bake {
namespace {

/// A lattice point; two steps per finest cell, so that the middle of every cell is one too.
using Corner = std::pair<int, int>;

/// A square of the floor by its lowest corner and edge.
struct Cell {
    int x, z, size;
};

void refine(const FloorOptions& options, const Cell& cell, std::vector<Cell>& leaves) {
    const double unit = 0.5 * options.finest;
    // Distance from the origin to the nearest point of the cell.
    const auto gap = [&](int low) { return unit * std::max({0, low, -(low + cell.size)}); };
    const double distance = std::hypot(gap(cell.x), gap(cell.z));
    const double allowed =
        std::max(options.finest, options.growth * (distance - options.fine_radius));
    if (cell.size <= 2 || unit * cell.size <= allowed) {
        leaves.push_back(cell);
        return;
    }
    const int half = cell.size / 2;
    for (const int dz : {0, half}) {
        for (const int dx : {0, half}) {
            refine(options, {cell.x + dx, cell.z + dz, half}, leaves);
        }
    }
}

}  // namespace

TriangleMesh make_floor(const FloorOptions& options) {
    std::vector<Cell> leaves;
    const int size = 2 << options.levels;
    refine(options, {-size / 2, -size / 2, size}, leaves);

    TriangleMesh mesh;
    std::map<Corner, std::uint32_t> index;
    const auto vertex = [&](const Corner& corner) {
        const auto [at, added] =
            index.try_emplace(corner, static_cast<std::uint32_t>(mesh.position.size()));
        if (added) {
            const double unit = 0.5 * options.finest;
            mesh.position.emplace_back(unit * corner.first, 0.0, unit * corner.second);
            mesh.normal.emplace_back(0.0, 1.0, 0.0);
        }
        return at->second;
    };
    for (const Cell& cell : leaves) {
        for (const int dz : {0, cell.size}) {
            for (const int dx : {0, cell.size}) {
                vertex({cell.x + dx, cell.z + dz});
            }
        }
    }
    for (const Cell& cell : leaves) {
        // The outline counter-clockwise from above, with the corners of smaller neighbours.
        const int x0 = cell.x, z0 = cell.z, x1 = cell.x + cell.size, z1 = cell.z + cell.size;
        const Corner corner[] = {{x0, z0}, {x0, z1}, {x1, z1}, {x1, z0}};
        std::vector<std::uint32_t> outline;
        for (std::size_t i = 0; i < 4; ++i) {
            const Corner &a = corner[i], &b = corner[(i + 1) % 4];
            outline.push_back(vertex(a));
            const auto middle = index.find({(a.first + b.first) / 2, (a.second + b.second) / 2});
            if (cell.size > 2 && middle != index.end()) outline.push_back(middle->second);
        }
        if (outline.size() == 4) {
            // Diagonals alternate, so that the floor has no grain.
            const auto turn = static_cast<std::size_t>((x0 / cell.size + z0 / cell.size) & 1);
            const auto at = [&](std::size_t i) { return outline[(i + turn) % 4]; };
            mesh.triangles.push_back({at(0), at(1), at(2)});
            mesh.triangles.push_back({at(0), at(2), at(3)});
            continue;
        }
        const std::uint32_t middle = vertex({x0 + cell.size / 2, z0 + cell.size / 2});
        for (std::size_t i = 0; i < outline.size(); ++i) {
            mesh.triangles.push_back({middle, outline[i], outline[(i + 1) % outline.size()]});
        }
    }
    return mesh;
}

}  // namespace opaline::bake
