#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/volumes/place_nodes.h"
#include "bake/volumes/volume_walks.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// The attenuated light of all nodes, as rows and for walks.
struct LitNodes {
    std::vector<formats::SparseRow> row;
    DepthTable depths;
};

/// Follows it from the sky to each node: rows V, not yet shared out, and depths toward the coarse
/// cells. Counts `rays`. The same bits for any number of threads; incomplete if the context is
/// cancelled.
LitNodes light_nodes(const VolumeJob& job, const PlacedNodes& nodes, const Context& context,
                     std::uint64_t& rays);

}  // namespace opaline::bake
