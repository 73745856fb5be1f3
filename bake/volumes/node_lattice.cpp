#include "bake/volumes/node_lattice.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "formats/opal/volumes.h"

namespace opaline::bake {
namespace {

using Grid = formats::SparseGrid<float>;

// Whether any voxel from `low` to `high`, both included, has density.
bool has_density(const Grid& grid, glm::ivec3 low, glm::ivec3 high) {
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            for (int x = low.x; x <= high.x; ++x) {
                if (grid.at({x, y, z}) > 0) {
                    return true;
                }
            }
        }
    }
    return false;
}

// Whether any of the voxels 8 b .. 8 b + 8 sends out light.
bool reaches_glow(const formats::SparseGrid<glm::vec3>& glow, glm::ivec3 brick) {
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 above(c & 1, c >> 1 & 1, c >> 2);
        if (glow.brick_at(brick + above) != formats::SparseGrid<glm::vec3>::kEmpty) {
            return true;
        }
    }
    return false;
}

struct VoxelHash {
    std::size_t operator()(const glm::ivec3& v) const {
        std::uint64_t h = 0;
        for (int axis = 0; axis < 3; ++axis) {
            h = (h ^ static_cast<std::uint32_t>(v[axis])) * 0x9e3779b97f4a7c15u;
            h ^= h >> 29;
        }
        return static_cast<std::size_t>(h);
    }
};

// Which cells of a brick's lattice have density, x fastest.
std::vector<bool> cells_with_density(const Grid& grid, glm::ivec3 brick, int spacing) {
    const int cells = Grid::kSide / spacing;
    std::vector<bool> has;
    for (int z = 0; z < cells; ++z) {
        for (int y = 0; y < cells; ++y) {
            for (int x = 0; x < cells; ++x) {
                const glm::ivec3 low = brick * Grid::kSide + spacing * glm::ivec3(x, y, z);
                has.push_back(has_density(grid, low, low + spacing));
            }
        }
    }
    return has;
}

bool touches_density(const std::vector<bool>& has, glm::ivec3 corner, int cells) {
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 at = corner - glm::ivec3(c & 1, c >> 1 & 1, c >> 2);
        if (at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < cells && at.y < cells && at.z < cells &&
            has[(static_cast<std::size_t>(at.z) * static_cast<std::size_t>(cells) +
                 static_cast<std::size_t>(at.y)) *
                    static_cast<std::size_t>(cells) +
                static_cast<std::size_t>(at.x)]) {
            return true;
        }
    }
    return false;
}

}  // namespace

NodeLattice make_node_lattice(const Grid& grid, std::uint32_t spacing,
                              const formats::SparseGrid<glm::vec3>& glow) {
    NodeLattice lattice;
    lattice.spacing = spacing;
    lattice.first_brick = grid.first_brick - 1;
    lattice.extent = grid.extent + 1;
    const int step = static_cast<int>(spacing), cells = Grid::kSide / step;
    std::unordered_map<glm::ivec3, std::uint32_t, VoxelHash> number;
    glm::ivec3 b;
    for (b.z = 0; b.z < lattice.extent.z; ++b.z) {
        for (b.y = 0; b.y < lattice.extent.y; ++b.y) {
            for (b.x = 0; b.x < lattice.extent.x; ++b.x) {
                const glm::ivec3 brick = lattice.first_brick + b;
                const std::vector<bool> has = cells_with_density(grid, brick, step);
                if (std::ranges::find(has, true) == has.end() && !reaches_glow(glow, brick)) {
                    lattice.table.push_back(formats::kNoBrick);
                    continue;
                }
                lattice.table.push_back(static_cast<std::uint32_t>(lattice.brick.size()));
                lattice.brick.push_back(brick);
                glm::ivec3 c;
                for (c.z = 0; c.z <= cells; ++c.z) {
                    for (c.y = 0; c.y <= cells; ++c.y) {
                        for (c.x = 0; c.x <= cells; ++c.x) {
                            if (!touches_density(has, c, cells)) {
                                lattice.corner.push_back(formats::kNoNode);
                                continue;
                            }
                            const glm::ivec3 voxel = brick * Grid::kSide + c * step;
                            const auto [at, is_new] = number.try_emplace(
                                voxel, static_cast<std::uint32_t>(lattice.node.size()));
                            if (is_new) {
                                lattice.node.push_back(voxel);
                            }
                            lattice.corner.push_back(at->second);
                        }
                    }
                }
            }
        }
    }
    return lattice;
}

NodesAround nodes_around(const NodeLattice& lattice, glm::vec3 index) {
    constexpr auto kSide = static_cast<float>(Grid::kSide);
    NodesAround around;
    around.node.fill(formats::kNoNode);
    const glm::vec3 low = glm::floor(index / kSide);
    const glm::ivec3 b = glm::ivec3(low) - lattice.first_brick;
    if (b.x < 0 || b.y < 0 || b.z < 0 || b.x >= lattice.extent.x || b.y >= lattice.extent.y ||
        b.z >= lattice.extent.z) {
        return around;
    }
    const std::uint32_t brick =
        lattice.table[(static_cast<std::size_t>(b.z) * static_cast<std::size_t>(lattice.extent.y) +
                       static_cast<std::size_t>(b.y)) *
                          static_cast<std::size_t>(lattice.extent.x) +
                      static_cast<std::size_t>(b.x)];
    if (brick == formats::kNoBrick) {
        return around;
    }
    const int cells = Grid::kSide / static_cast<int>(lattice.spacing);
    const glm::vec3 at = (index - low * kSide) / static_cast<float>(lattice.spacing);
    const glm::ivec3 cell = glm::clamp(glm::ivec3(at), 0, cells - 1);
    const glm::vec3 f = glm::clamp(at - glm::vec3(cell), 0.0f, 1.0f);
    const auto along = static_cast<std::size_t>(cells) + 1;
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 corner = cell + glm::ivec3(c & 1, c >> 1 & 1, c >> 2);
        const auto i = static_cast<std::size_t>(c);
        around.node[i] = lattice.corner[brick * along * along * along +
                                        (static_cast<std::size_t>(corner.z) * along +
                                         static_cast<std::size_t>(corner.y)) *
                                            along +
                                        static_cast<std::size_t>(corner.x)];
        around.weight[i] = ((c & 1) != 0 ? f.x : 1 - f.x) * ((c & 2) != 0 ? f.y : 1 - f.y) *
                           ((c & 4) != 0 ? f.z : 1 - f.z);
    }
    around.found = true;
    return around;
}

std::uint32_t choose_spacing(std::span<const float> values, const glm::dmat4& to_scene,
                             double sigma_t, double depth) {
    double sum = 0, squares = 0;
    for (const float density : values) {
        sum += static_cast<double>(density);
        squares += static_cast<double>(density) * static_cast<double>(density);
    }
    const double typical = sum > 0 ? sigma_t * squares / sum : 0;
    const double edge =
        std::max({glm::length(glm::dvec3(to_scene[0])), glm::length(glm::dvec3(to_scene[1])),
                  glm::length(glm::dvec3(to_scene[2]))});
    std::uint32_t spacing = 1;
    while (spacing < 8 && typical * edge * 2 * spacing <= depth) {
        spacing *= 2;
    }
    return spacing;
}

}  // namespace opaline::bake
