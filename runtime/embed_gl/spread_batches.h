#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/asset.h"
#include "runtime/embed_gl/dot_batches.h"

namespace opaline::runtime {

/// Consecutive vertices of one primitive that a single dispatch gives the radiance of their slots.
struct SpreadBatch {
    std::uint32_t primitive = 0, vertices = 0;
    std::uint32_t least_slot = 0;  ///< that `shown` begins with
    BoundRange slot;               ///< SlotsView::slot, or mix, of the vertices
    BoundRange shown;              ///< radiance of all slots that they have
    BoundRange radiance;           ///< of the vertices
};

/// Bytes of a vertex's slots: SlotsView::slot, or mix where there is one.
std::size_t bytes_of_slots(const formats::SlotsView& slots);

/// Splits all primitives' vertices so that every range of every batch keeps the limits; none where
/// no vertices share rows. Precondition: a range of one element does (plan_dot_batches); a vertex
/// that is mixed of slots so far apart that they do not fit is a batch by itself, which OpenGL may
/// refuse.
std::vector<SpreadBatch> plan_spread_batches(const formats::AssetView& asset,
                                             const DotLimits& limits);

}  // namespace opaline::runtime
