#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/glow.h"
#include "formats/opal/phase_table.h"
#include "formats/opal/rgb.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::formats {

/// What an `.opal` file holds of volumes such as smoke or clouds; formats/README.md, `VOLU`.

inline constexpr int kBrickSide = 8;  ///< voxels along an edge of a brick of density
inline constexpr std::size_t kBrickVoxels = std::size_t{kBrickSide} * kBrickSide * kBrickSide;
inline constexpr std::uint32_t kNoBrick = 0xffffffffu;  ///< in a table: no density there
inline constexpr std::uint32_t kNoNode = 0xffffffffu;   ///< among corners: no density near it
inline constexpr std::uint32_t kMaxVolumeMoments = 5;   ///< degrees 0 to 4

/// One volume. Its density stands on a lattice of voxels in bricks of 8 x 8 x 8: voxel (i, j, k)
/// has its centre at the index coordinates (i, j, k), brick b holds the voxels 8 b .. 8 b + 7, and
/// the density is trilinear between centres, 0 where no brick is. Light is known at *nodes*, every
/// `spacing` voxels: a brick has (8 / spacing + 1)^3 corners from 8 b to 8 b + 8 along each axis,
/// and refers to a node at each of them. Every point with density lies in a brick. Fixed size,
/// stored as is.
struct VolumeRecord {
    std::array<float, 12> to_world{};  ///< 3 x 4, row after row: index coordinates to world [m]
    Rgb sigma_t;                       ///< extinction [1/m] where the density is 1
    Rgb albedo;                        ///< single-scattering albedo, in [0, 1]
    std::array<std::int32_t, 3> first_brick{};  ///< lowest corner of the table
    std::array<std::uint32_t, 3> extent{};      ///< bricks along each axis of the table
    std::uint32_t first_brick_number = 0, brick_count = 0;
    std::uint64_t first_cell = 0;    ///< of the table, which has extent.x * extent.y * extent.z
    std::uint64_t first_corner = 0;  ///< brick_count * (8 / spacing + 1)^3 corners
    std::uint32_t spacing = 1;       ///< voxels between nodes: 1, 2, 4 or 8
    std::uint32_t first_node = 0, node_count = 0;
    std::uint32_t single_terms = 0;    ///< K_s: 0, 1, 4, 9, 16 or 25
    std::uint32_t multiple_terms = 0;  ///< K_m: 0, 1, 4, 9, 16 or 25
    std::uint32_t bands = 1;           ///< 1 grey, 3 RGB; of all rows
    std::uint32_t first_row = 0, first_band_row = 0;
    std::uint64_t first_code = 0;
    /// Legendre moments of the phase function, by degree; those of degrees that K_s has are used.
    /// They are for light that varies slowly with direction; the phase function itself is in
    /// VolumesView::phase.
    std::array<float, kMaxVolumeMoments> moment{};
    std::array<std::uint32_t, 3> reserved{};

    /// Rows of a node: row 0 is the share of the light of each direction that reaches the node
    /// unscattered, the others are multiple scattering.
    std::uint32_t terms() const { return 1 + multiple_terms; }
    std::uint32_t corners_along_edge() const { return 8 / spacing + 1; }
    std::size_t corners_of_brick() const {
        const std::size_t n = corners_along_edge();
        return n * n * n;
    }
    RowRange rows() const {
        return {first_row, node_count * terms(), bands, first_band_row, first_code};
    }
};
static_assert(sizeof(VolumeRecord) == 192);

/// The voxel in which a node stands.
using NodeVoxel = std::array<std::int32_t, 3>;

/// All volumes of an asset as spans, into the bytes of a file or into `Volumes`. Immutable.
struct VolumesView {
    std::span<const VolumeRecord> records;
    std::span<const std::uint32_t> table;    ///< bricks of a volume, counted from its first one,
                                             ///< or kNoBrick; x fastest
    std::span<const float> density_scale;    ///< per brick: density = code * scale
    std::span<const std::uint16_t> density;  ///< codes, 512 per brick, x fastest
    std::span<const std::uint32_t> corner;   ///< nodes of a volume, counted from its first one, or
                                             ///< kNoNode; brick after brick, x fastest
    std::span<const NodeVoxel> node;         ///< (i, j, k) of each node
    std::span<const float> phase;            ///< kPhaseEntries a volume: p', see ball_bank.h
    SparseRowsView rows;                     ///< terms() rows a node
    GlowView glow;                           ///< light of their own; empty without any

    bool empty() const { return records.empty(); }

    /// The phase function of a volume.
    std::span<const float> phase_of(std::size_t volume) const {
        return phase.subspan(volume * kPhaseEntries, kPhaseEntries);
    }
};

/// Owning twin of `VolumesView`: what the baker builds.
struct Volumes {
    std::vector<VolumeRecord> records;
    std::vector<std::uint32_t> table;
    std::vector<float> density_scale;
    std::vector<std::uint16_t> density;
    std::vector<std::uint32_t> corner;
    std::vector<NodeVoxel> node;
    std::vector<float> phase;
    SparseRows rows;
    Glow glow;

    VolumesView view() const {
        return {records, table, density_scale, density,    corner,
                node,    phase, rows.view(),   glow.view()};
    }
};

}  // namespace opaline::formats
