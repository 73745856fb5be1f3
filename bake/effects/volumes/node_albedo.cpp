#include "bake/effects/volumes/node_albedo.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bake/trace/density/grid_loops.h"

namespace opaline::bake {
namespace {

using Grid = formats::SparseGrid<float>;

// Sums over the voxels less than `reach` from a node along each axis.
struct TentSum {
    glm::vec3 scattering{0};
    float density = 0;
};

TentSum sum_tent(const DensityVolume& volume, glm::ivec3 node, int reach) {
    TentSum sum;
    for_each_voxel_around(node, reach, [&](glm::ivec3 voxel, float weight) {
        const float density = volume.grid->at(voxel);
        if (density > 0) {
            sum.density += weight * density;
            sum.scattering += weight * volume.scattering->at(voxel);
        }
    });
    return sum;
}

glm::vec3 albedo_of_node(const DensityVolume& volume, glm::ivec3 node, std::uint32_t spacing) {
    const int reach = static_cast<int>(spacing);
    TentSum sum = sum_tent(volume, node, reach);
    if (!(sum.density > 0)) {
        // At the edge of the density, which begins next to this node.
        sum = sum_tent(volume, node, reach + 1);
    }
    return sum.density > 0 ? sum.scattering / sum.density : glm::vec3(0);
}

// Voxels of one brick: sums of density times squares.
struct Squares {
    double lost = 0, all = 0;
};

Squares compare_brick(const DensityVolume& volume, glm::ivec3 brick, std::uint32_t spacing) {
    const int step = static_cast<int>(spacing), side = Grid::kSide / step + 1;
    std::vector<glm::vec3> corner;
    for (int i = 0; i < side * side * side; ++i) {
        const glm::ivec3 at(i % side, i / side % side, i / (side * side));
        corner.push_back(albedo_of_node(volume, Grid::kSide * brick + step * at, spacing));
    }
    Squares sum;
    for (int i = 0; i < static_cast<int>(Grid::kBrickVoxels); ++i) {
        const glm::ivec3 at(i % Grid::kSide, i / Grid::kSide % Grid::kSide,
                            i / (Grid::kSide * Grid::kSide));
        const float density = volume.grid->at(Grid::kSide * brick + at);
        if (!(density > 0)) continue;
        const glm::ivec3 low = at / step;
        const glm::vec3 w = glm::vec3(at - step * low) / static_cast<float>(step);
        glm::vec3 between(0);
        for (int c = 0; c < 8; ++c) {
            const glm::ivec3 up = corner_of_cube(c), node = low + up;
            const glm::vec3 each = glm::mix(1.0f - w, w, glm::vec3(up));
            const int number = (node.z * side + node.y) * side + node.x;
            between += each.x * each.y * each.z * corner[static_cast<std::size_t>(number)];
        }
        const glm::vec3 own = volume.scattering->at(Grid::kSide * brick + at) / density;
        const glm::vec3 lost = own - between;
        sum.lost += static_cast<double>(density * glm::dot(lost, lost));
        sum.all += static_cast<double>(density * glm::dot(own, own));
    }
    return sum;
}

}  // namespace

std::vector<glm::vec3> node_albedo_shares(const DensityVolume& volume, const NodeLattice& lattice) {
    std::vector<glm::vec3> shares(lattice.node.size(), glm::vec3(1));
    if (volume.scattering == nullptr) return shares;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const glm::vec3 own = albedo_of_node(volume, lattice.node[i], lattice.spacing);
        for (int band = 0; band < 3; ++band) {
            const float largest = volume.albedo[static_cast<std::size_t>(band)];
            shares[i][band] = largest > 0 ? std::min(own[band] / largest, 1.0f) : 1.0f;
        }
    }
    return shares;
}

double lost_albedo_detail(const DensityVolume& volume, std::uint32_t spacing) {
    if (volume.scattering == nullptr || spacing <= 1) return 0;
    constexpr std::size_t kMostBricks = 1024;
    const Grid& grid = *volume.grid;
    const std::size_t stride = (grid.brick_count() + kMostBricks - 1) / kMostBricks;
    Squares sum;
    std::size_t seen = 0;
    for_each_point(grid.first_brick, grid.first_brick + grid.extent, [&](glm::ivec3 brick) {
        if (grid.brick_at(brick) != Grid::kEmpty && seen++ % stride == 0) {
            const Squares own = compare_brick(volume, brick, spacing);
            sum.lost += own.lost;
            sum.all += own.all;
        }
    });
    return sum.all > 0 ? std::sqrt(sum.lost / sum.all) : 0;
}

}  // namespace opaline::bake
