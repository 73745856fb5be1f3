#pragma once

#include <cstdint>

#include "bake/base/context.h"
#include "bake/volumes/place_nodes.h"
#include "formats/opal/glow.h"

namespace opaline::bake {

/// Light that glowing volumes emit, and the part of it that the nodes of all volumes scatter.
/// `emitter` of a record is the number among glowing layouts, `volume` that among layouts. The same
/// bits for any number of threads; empty once the context is cancelled. Adds the rays traced to
/// `rays`.
formats::Glow bake_glow(const VolumeJob& job, const PlacedNodes& nodes, const Context& context,
                        std::uint64_t& rays);

}  // namespace opaline::bake
