#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"
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

/// A ray on its way through the table of a volume, brick after brick [AmanatidesWoo1987].
/// Coordinates in bricks, from the table's lowest corner: p(t) = origin + t direction, t the
/// distance in the world [m].
struct BrickWalk {
    std::array<double, 3> origin{}, direction{};
    std::array<std::int32_t, 3> cell{};
    double t = 0, end = 0;  ///< rest of the ray; empty if t >= end
};

/// A part of the ray within one brick that exists; begin < end, both finite.
struct BrickSpan {
    double begin = 0, end = 0;
    std::array<std::int32_t, 3> cell{};
};

/// The walk of the ray between the distances `begin` and `end`, cut to the table. Nothing to walk
/// where they do not meet, or where one of origin and direction is not finite or the direction is
/// zero.
BrickWalk start_walk(const VolumeLattice& lattice, formats::Vec3 origin, formats::Vec3 direction,
                     double begin, double end);

/// The next brick, and the walk moved past it. Visits each layer of the table at most once along
/// each axis, so that a whole walk takes at most extent.x + extent.y + extent.z steps.
std::optional<BrickSpan> next_brick(const VolumeLattice& lattice, BrickWalk& walk);

/// Light that a volume sends out by itself, ready for rays.
struct VolumeGlow {
    std::vector<std::uint32_t> place;  ///< of each brick of the volume: its number among `code`, or
                                       ///< kNoBrick; empty: the volume does not glow
    std::span<const std::uint32_t> code;  ///< 512 a brick, half.h
    float scale = 0;                      ///< of codes

    bool empty() const { return place.empty(); }
};

/// Precondition: the asset passed read_opal's checks.
VolumeGlow make_glow(const formats::VolumesView& volumes, std::size_t volume);

/// Radiance per metre [W m^-3 sr^-1] of the emitter as authored, trilinear, at a point of the
/// block's brick; `at` as density_at's. Precondition: not empty().
formats::Rgb glow_at(const VolumeGlow& glow, const BrickBlock& block, std::array<float, 3> at);

}  // namespace opaline::runtime
