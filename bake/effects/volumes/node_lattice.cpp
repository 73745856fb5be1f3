#include "bake/effects/volumes/node_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/trace/density/grid_loops.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {
namespace {

using Grid = formats::SparseGrid<float>;

// Whether any of the voxels 8 b .. 8 b + 8 sends out light.
bool reaches_glow(const formats::SparseGrid<glm::vec3>& glow, glm::ivec3 brick) {
    for (int c = 0; c < 8; ++c) {
        if (glow.brick_at(brick + corner_of_cube(c)) != formats::SparseGrid<glm::vec3>::kEmpty) {
            return true;
        }
    }
    return false;
}

// Which cells of a brick's lattice have density at one of their corners or between, x fastest.
// Empty: none has.
std::vector<bool> cells_with_density(const Grid& grid, glm::ivec3 brick, int spacing) {
    std::array<const float*, 8> values{};  // of the brick and those above it, which it reaches
    bool is_empty = true;
    for (int c = 0; c < 8; ++c) {
        const std::uint32_t number = grid.brick_at(brick + corner_of_cube(c));
        if (number != Grid::kEmpty) {
            values[static_cast<std::size_t>(c)] = grid.brick(number).data();
            is_empty = false;
        }
    }
    std::vector<bool> has;
    if (is_empty) return has;
    constexpr int kSide = Grid::kSide;
    const int cells = kSide / spacing;
    const auto along = static_cast<std::size_t>(cells);
    has.resize(along * along * along);
    is_empty = true;
    for_each_point(glm::ivec3(0), glm::ivec3(kSide + 1), [&](glm::ivec3 v) {
        const glm::ivec3 above = v / kSide;
        const float* const own =
            values[static_cast<std::size_t>(above.z << 2 | above.y << 1 | above.x)];
        if (own == nullptr || !(own[Grid::offset_in_brick(v)] > 0)) return;
        is_empty = false;
        // Both cells that share a voxel have what it has.
        for_each_point(glm::max((v + spacing - 1) / spacing - 1, glm::ivec3(0)),
                       glm::min(v / spacing + 1, glm::ivec3(cells)),
                       [&](glm::ivec3 cell) { has[number_in(glm::ivec3(cells), cell)] = true; });
    });
    return is_empty ? std::vector<bool>() : has;
}

bool touches_density(const std::vector<bool>& has, glm::ivec3 corner, int cells) {
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 at = corner - corner_of_cube(c);
        if (is_within(glm::ivec3(cells), at) && has[number_in(glm::ivec3(cells), at)]) return true;
    }
    return false;
}

// Numbers of nodes: (8 / spacing)^3 for each brick that owns one.
class NodeNumbers {
  public:
    NodeNumbers(glm::ivec3 first_brick, glm::ivec3 extent, int spacing)
        : first_(first_brick),
          extent_(extent),
          spacing_(spacing),
          cells_(Grid::kSide / spacing),
          block_(number_in(extent, {0, 0, extent.z}), Grid::kEmpty) {}
    // kNoNode until it is set. Precondition: the voxel's coordinates are multiples of the spacing,
    // in one of the bricks.
    std::uint32_t& at(glm::ivec3 voxel) {
        const glm::ivec3 brick = Grid::brick_of(voxel);
        const auto size = static_cast<std::uint32_t>(cells_ * cells_ * cells_);
        std::uint32_t& block = block_[number_in(extent_, brick - first_)];
        if (block == Grid::kEmpty) {
            block = static_cast<std::uint32_t>(number_.size() / size);
            number_.resize(number_.size() + size, formats::kNoNode);
        }
        const glm::ivec3 c = (voxel - brick * Grid::kSide) / spacing_;
        return number_[std::size_t{block} * size + number_in(glm::ivec3(cells_), c)];
    }

  private:
    glm::ivec3 first_, extent_;
    int spacing_, cells_;
    std::vector<std::uint32_t> block_;  // of bricks, x fastest
    std::vector<std::uint32_t> number_;
};

}  // namespace

NodeLattice make_node_lattice(const Grid& grid, std::uint32_t spacing,
                              const formats::SparseGrid<glm::vec3>& glow) {
    NodeLattice lattice;
    lattice.spacing = spacing;
    lattice.first_brick = grid.first_brick - 1;
    lattice.extent = grid.extent + 1;
    const int step = static_cast<int>(spacing), cells = Grid::kSide / step;
    NodeNumbers number(lattice.first_brick, lattice.extent + 1, step);
    const auto end = lattice.first_brick + lattice.extent;
    for_each_point(lattice.first_brick, end, [&](glm::ivec3 brick) {
        const std::vector<bool> has = cells_with_density(grid, brick, step);
        if (has.empty() && !reaches_glow(glow, brick)) {
            lattice.table.push_back(formats::kNoBrick);
            return;
        }
        lattice.table.push_back(static_cast<std::uint32_t>(lattice.brick.size()));
        lattice.brick.push_back(brick);
        for_each_point(glm::ivec3(0), glm::ivec3(cells + 1), [&](glm::ivec3 c) {
            if (has.empty() || !touches_density(has, c, cells)) {
                lattice.corner.push_back(formats::kNoNode);
                return;
            }
            const glm::ivec3 voxel = brick * Grid::kSide + c * step;
            std::uint32_t& node = number.at(voxel);
            if (node == formats::kNoNode) {
                node = static_cast<std::uint32_t>(lattice.node.size());
                lattice.node.push_back(voxel);
            }
            lattice.corner.push_back(node);
        });
    });
    return lattice;
}

NodesAround nodes_around(const NodeLattice& lattice, glm::vec3 index) {
    constexpr auto kSide = static_cast<float>(Grid::kSide);
    NodesAround around;
    around.node.fill(formats::kNoNode);
    const glm::vec3 low = glm::floor(index / kSide);
    const glm::ivec3 b = glm::ivec3(low) - lattice.first_brick;
    if (!is_within(lattice.extent, b)) return around;
    const std::uint32_t brick = lattice.table[number_in(lattice.extent, b)];
    if (brick == formats::kNoBrick) return around;
    const int cells = Grid::kSide / static_cast<int>(lattice.spacing);
    const glm::vec3 at = (index - low * kSide) / static_cast<float>(lattice.spacing);
    const glm::ivec3 cell = glm::clamp(glm::ivec3(at), 0, cells - 1);
    const glm::vec3 f = glm::clamp(at - glm::vec3(cell), 0.0f, 1.0f);
    const glm::ivec3 corners(cells + 1);
    const std::size_t first = brick * number_in(corners, {0, 0, cells + 1});
    for (int c = 0; c < 8; ++c) {
        const auto i = static_cast<std::size_t>(c);
        around.node[i] = lattice.corner[first + number_in(corners, cell + corner_of_cube(c))];
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

std::vector<float> node_densities(const formats::SparseGrid<float>& density,
                                  const NodeLattice& lattice) {
    float most = 0;
    std::vector<float> means;
    means.reserve(lattice.node.size());
    for (const glm::ivec3 node : lattice.node) {
        float sum = 0;
        for_each_voxel_around(
            node, static_cast<int>(lattice.spacing),
            [&](glm::ivec3 voxel, float weight) { sum += weight * density.at(voxel); });
        means.push_back(sum);
        most = std::max(most, sum);
    }
    for (float& mean : means) {
        mean = most > 0 ? mean / most : 0.0f;
    }
    return means;
}

float mean_visibility(const formats::SparseRow& attenuated, std::uint32_t n) {
    double sum = 0;
    for (const auto* values : {&attenuated.value, &attenuated.average}) {
        for (const float v : *values) {
            sum += static_cast<double>(v) * static_cast<double>(v);
        }
    }
    // Haar's functions are orthonormal over texels.
    return static_cast<float>(std::sqrt(sum / (formats::cubemap_texels(n) * attenuated.bands)));
}

}  // namespace opaline::bake
