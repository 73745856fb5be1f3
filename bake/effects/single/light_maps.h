#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/effects/single/light_view.h"
#include "bake/effects/single/packed_rows.h"
#include "bake/effects/single/ray_single.h"

namespace opaline::bake {

/// Single scattering of many receivers.
struct SingleRows {
    PackedRows rows;
    EntryCounts counts;          ///< of the rays traced
    std::uint64_t look_ups = 0;  ///< asked of light views
    std::uint64_t unsure = 0;    ///< of them, those that maps could not surely answer
};

/// Pixels across at which a pixel is a quarter of a mean edge, in [128, 2048].
std::uint32_t light_view_size(const BodyMesh& mesh);

/// T_k of all `points`, which must be of the medium's material; the result of gather_single for
/// the same directions but for errors of the maps: .2 to 1 % of a relit value (RMS) on closed
/// bodies and thin sheets; on a scan with holes and overlaps .6 to 1.1 %, median .2 %, half of it
/// from the one receiver in a hundred that is beside its faults and too bright.
///
/// The loops are transposed: for each direction the medium's boundary is rendered once along it,
/// and every interior node of every receiver is looked up: it is lit from the front layer above it
/// if no back layer and no blocker lies between. What cannot be looked up surely is traced, in
/// packets of sixteen that share the direction, if it matters; of what matters little, a random
/// part is, or the nearest pixel decides.
///
/// Memory: 4 K bytes a receiver and texel (packed_rows_in), 60 bytes a receiver and node, and per
/// thread one view and 12 K bytes a receiver; with one band 2 K, 52 and 4 K bytes. Callers cut
/// `points` accordingly; each call renders all views anew. `size`: pixels across. Bit-identical for
/// any number of threads, and for any cut. Cancelled: the rows are incomplete.
SingleRows gather_single_rows(const RayScene& rays, const BodyMesh& mesh, std::uint32_t size,
                              const DirectionSet& directions, const SingleMedium& medium,
                              std::span<const BodyPoint> points, const Context& context);

}  // namespace opaline::bake
