#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"
#include "runtime/volumes/volume_lattice.h"

namespace opaline::runtime {

/// Density of a volume between its points of suns (sun_light.h) and each sun.
struct SunColumns {
    VolumeLattice lattice;
    std::size_t volume = 0;                    ///< its number in the asset
    std::vector<std::uint32_t> cell_of_brick;  ///< in the table, x fastest
    /// [m] Density times way from a point out of the volume: column[sun][brick * points() + point].
    std::vector<std::vector<float>> column;

    std::array<std::int32_t, 3> cell(std::uint32_t brick) const;
    std::uint32_t boxes() const { return sun_boxes(*lattice.record); }
    std::size_t points() const {
        const std::size_t side = boxes() + 1;
        return side * side * side;
    }
};

/// Those of the volumes that rays may meet, in their order. No columns yet.
std::vector<SunColumns> place_volumes(const formats::VolumesView& volumes);

/// Finds the columns toward `suns` [world, unit] in all volumes.
///
/// Columns are a voxel apart along the two axes with the smaller components of the sun's direction,
/// and parallel to it: the plane at height h of the third axis meets column (U, V) at (U + m_u h, V
/// + m_v h), so that all columns have the same offset from voxels in one plane. Planes of voxels
/// are added from the sun on, by the trapezoidal rule; a point reads the four columns around it.
/// The same bits for any number of threads.
void find_sun_columns(std::span<SunColumns> volumes, std::span<const formats::Vec3> suns,
                      unsigned threads);

/// The same from any place of the world: where the ray comes into a brick, between its points.
float column_from(const SunColumns& volume, std::size_t number, formats::Vec3 sun,
                  formats::Vec3 from);

/// Bricks share points on their faces. The value of a point is stored in the brick that contains
/// it: on upper faces that is the next one, if there is one.
struct PointOwner {
    std::uint32_t brick = 0;
    std::size_t point = 0;
};
/// `block`: of the cell of `brick`; `place`: of the point in it, each up to `boxes`.
PointOwner point_owner(std::uint32_t brick, const BrickBlock& block, std::uint32_t boxes,
                       const std::array<std::uint32_t, 3>& place);

/// Numbers of the volumes other than `own` that may shadow its points from each sun: those whose
/// table the light of that sun crosses before or while it crosses the table of `own`. Conservative
/// up to the rounding of positions.
std::vector<std::vector<std::size_t>> find_shades(std::span<const SunColumns> volumes,
                                                  std::size_t own,
                                                  std::span<const formats::Vec3> suns);

}  // namespace opaline::runtime
