#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/effects/single/light_view.h"
#include "bake/effects/single/packed_rows.h"
#include "bake/effects/single/ray_single.h"
#include "bake/trace/direction_set.h"

namespace opaline::bake {

/// Single scattering of many receivers.
struct SingleRows {
    PackedRows rows;
    EntryCounts counts;          ///< of the rays traced
    std::uint64_t look_ups = 0;  ///< in light views
    std::uint64_t unsure = 0;    ///< look-ups that a view could not decide
};

/// View size at which a pixel is a quarter of a mean edge, in [128, 2048] pixels.
std::uint32_t light_view_size(const BodyMesh& mesh);

/// T_k of all `points`, which must be of the medium's material. The result differs from
/// gather_single with the same directions by 0.2 to 1 % of a relit value (RMS) on closed bodies and
/// thin sheets. On a scan with holes and overlaps the difference is 0.6 to 1.1 % (median 0.2 %);
/// half of it comes from the 1 % of receivers beside the scan's faults, which are too bright.
///
/// The outer loop runs over directions. For each, the medium's boundary is rendered once, and every
/// interior node of every receiver is looked up. A node is lit through the front layer above it if
/// no back layer and no blocker lies between. Undecided nodes are traced in packets of sixteen with
/// the same direction if their light matters. Of the others a random part is traced, or the nearest
/// pixel decides.
///
/// Memory: 4 K bytes a receiver and texel (packed_rows_in), 60 bytes a receiver and node, and per
/// thread one view and 12 K bytes a receiver; with one band 2 K, 52 and 4 K bytes. Callers cut
/// `points` accordingly; each call renders all views anew. `size`: pixels across. Bit-identical for
/// any number of threads, and for any cut. Cancelled: the rows are incomplete.
SingleRows gather_single_rows(const RayScene& rays, const BodyMesh& mesh, std::uint32_t size,
                              const DirectionSet& directions, const SingleMedium& medium,
                              std::span<const BodyPoint> points, const Context& context);

}  // namespace opaline::bake
