#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"

namespace opaline::runtime {

/// One volume, its arrays cut out of those of the asset, and the way from the world into it.
struct VolumeLattice {
    const formats::VolumeRecord* record = nullptr;
    std::array<double, 12> to_index{};       ///< 3 x 4, row after row: world [m] to index
    std::span<const std::uint32_t> table;    ///< bricks, counted from the volume's first one
    std::span<const float> density_scale;    ///< per brick
    std::span<const std::uint16_t> density;  ///< 512 codes a brick
    std::span<const std::uint32_t> corner;   ///< corners_of_brick() nodes a brick

    /// Inside the table, x fastest; kNoBrick outside.
    std::uint32_t brick(std::array<std::int32_t, 3> cell) const;
};

/// Nothing where the transform has no finite inverse: such a volume cannot be met by a ray.
/// Precondition: the asset passed read_opal's checks.
std::optional<VolumeLattice> make_lattice(const formats::VolumesView& volumes,
                                          const formats::VolumeRecord& record);

/// World to index coordinates: of a point, and of a direction [1/m].
std::array<double, 3> index_of_point(const VolumeLattice& lattice, formats::Vec3 point);
std::array<double, 3> index_of_direction(const VolumeLattice& lattice, formats::Vec3 direction);

/// A brick and its seven neighbours on the sides of +x, +y and +z: what is needed for the density
/// anywhere in it. number[x + 2 y + 4 z] is the brick at cell + (x, y, z).
struct BrickBlock {
    std::array<std::int32_t, 3> cell{};  ///< counts from the table's lowest corner
    std::array<std::uint32_t, 8> number{};
};
BrickBlock brick_block(const VolumeLattice& lattice, std::array<std::int32_t, 3> cell);

/// Trilinear density at a point of the block's brick: `at` in voxels from the brick's voxel
/// (0, 0, 0), in [0, 8].
float density_at(const VolumeLattice& lattice, const BrickBlock& block, std::array<float, 3> at);

/// The density at a brick's voxels and at those of its neighbours on the upper faces: 9 x 9 x 9, x
/// fastest.
inline constexpr std::size_t kPaddedSide = formats::kBrickSide + 1;
using PaddedBrick = std::array<float, kPaddedSide * kPaddedSide * kPaddedSide>;
PaddedBrick pad_brick(const VolumeLattice& lattice, std::array<std::int32_t, 3> cell);

/// The box between eight nodes in which a point of a brick lies, `at` as above.
struct NodeCell {
    std::uint32_t number = 0;       ///< of the box in its brick, x fastest
    std::array<float, 3> weight{};  ///< of the upper nodes along each axis, in [0, 1]
};
NodeCell node_cell(const VolumeLattice& lattice, std::array<float, 3> at);

/// Boxes between the points of a brick's edge at which light of suns is known: at half the distance
/// of nodes, but not closer than voxels.
std::uint32_t sun_boxes(const formats::VolumeRecord& record);

/// The box between eight points of a lattice with that many boxes along a brick's edge.
NodeCell box_at(std::uint32_t boxes, std::array<float, 3> at);

/// The eight nodes of a box, in the order x + 2 y + 4 z, or kNoNode.
std::array<std::uint32_t, 8> nodes_of_cell(const VolumeLattice& lattice, std::uint32_t brick,
                                           std::uint32_t cell);

}  // namespace opaline::runtime
