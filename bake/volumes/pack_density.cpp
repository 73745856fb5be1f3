#include "bake/volumes/pack_density.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opaline::bake {
namespace {

using Grid = formats::SparseGrid<float>;

// One brick: the nearest of 65535 even steps up to its largest voxel.
void append_brick(const Grid& grid, glm::ivec3 brick, formats::Volumes& volumes) {
    const std::uint32_t number = grid.brick_at(brick);
    if (number == Grid::kEmpty) {
        volumes.density_scale.push_back(0);
        volumes.density.insert(volumes.density.end(), formats::kBrickVoxels, std::uint16_t{0});
        return;
    }
    const std::span<const float> value = grid.brick(number);
    const float most = *std::ranges::max_element(value);
    const float scale = most / 65535;
    volumes.density_scale.push_back(scale);
    for (const float density : value) {
        // The scale of very thin density may round to 0.
        const float code = scale > 0 ? std::min(density / scale, 65535.0f) : 0.0f;
        volumes.density.push_back(static_cast<std::uint16_t>(std::lround(code)));
    }
}

}  // namespace

formats::Status pack_density(const formats::SparseGrid<float>& density, const std::string& name,
                             const NodeLattice& lattice, glm::dvec3 world,
                             formats::VolumeRecord& record, formats::Volumes& volumes) {
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() - 1;
    if (volumes.density_scale.size() + lattice.brick.size() > kMost ||
        volumes.node.size() + lattice.node.size() > kMost) {
        return formats::make_error(formats::ErrorKind::resource, "", name,
                                   "it has more than 2^32 bricks or points of light",
                                   "bake it in parts, or in larger voxels");
    }
    glm::dmat4 to_world = density.to_scene;
    to_world[3] += glm::dvec4(world, 0);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            record.to_world[static_cast<std::size_t>(4 * row + column)] =
                static_cast<float>(to_world[column][row]);
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        record.first_brick[axis] = lattice.first_brick[static_cast<int>(axis)];
        record.extent[axis] = static_cast<std::uint32_t>(lattice.extent[static_cast<int>(axis)]);
    }
    record.first_brick_number = static_cast<std::uint32_t>(volumes.density_scale.size());
    record.brick_count = static_cast<std::uint32_t>(lattice.brick.size());
    record.first_cell = volumes.table.size();
    record.first_corner = volumes.corner.size();
    record.spacing = lattice.spacing;
    record.first_node = static_cast<std::uint32_t>(volumes.node.size());
    record.node_count = static_cast<std::uint32_t>(lattice.node.size());
    volumes.table.insert(volumes.table.end(), lattice.table.begin(), lattice.table.end());
    volumes.corner.insert(volumes.corner.end(), lattice.corner.begin(), lattice.corner.end());
    for (const glm::ivec3 brick : lattice.brick) {
        append_brick(density, brick, volumes);
    }
    for (const glm::ivec3 voxel : lattice.node) {
        volumes.node.push_back({voxel.x, voxel.y, voxel.z});
    }
    return formats::ok_status();
}

}  // namespace opaline::bake
