#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/effects/volumes/place_nodes.h"
#include "bake/exchange/lamps/lamps.h"
#include "formats/opal/glow.h"

namespace opaline::bake {

/// Light that glowing volumes emit, and the part of it that the nodes of all volumes scatter.
/// `emitter` of a record is the number among glowing layouts, `volume` that among layouts. The same
/// bits for any number of threads; empty once the context is cancelled. Adds the rays traced to
/// `rays`.
formats::Glow bake_glow(const VolumeJob& job, const PlacedNodes& nodes, const Context& context,
                        std::uint64_t& rays);

/// Lamps and the surfaces of their scene, which may be another one than that of the nodes.
struct LampsOfScene {
    const formats::Scene& scene;
    std::span<const Lamp> lamps;
};

/// The part of the light of lamps that the nodes of all volumes scatter. `emitter` of a record is
/// the number among the lamps after those of glowing layouts; volumes that glow are none of them.
/// The same bits for any number of threads; empty once the context is cancelled. Adds the rays
/// traced to `rays`.
formats::Glow bake_lamp_glow(const VolumeJob& job, const PlacedNodes& nodes,
                             const LampsOfScene& lit, const Context& context, std::uint64_t& rays);

/// Both as one, by volume, then emitter, as a file has them. `other` has no bricks.
formats::Glow join_glow(const formats::Glow& glow, const formats::Glow& other);

}  // namespace opaline::bake
