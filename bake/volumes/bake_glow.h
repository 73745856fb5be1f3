#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/transport/ray_scene.h"
#include "bake/volumes/density_space.h"
#include "bake/volumes/node_lattice.h"
#include "bake/volumes/plan_volumes.h"
#include "formats/opal/glow.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What light of volumes is baked from.
struct GlowJob {
    const formats::Scene& scene;
    const RayScene& rays;
    const DensitySpace& space;
    std::span<const VolumeLayout> layouts;
    std::span<const NodeLattice> lattices;  ///< of each volume of the scene
    std::span<const std::size_t> first;     ///< number of each volume's first node among all
    std::span<const std::vector<glm::vec3>> albedo;  ///< node_albedo_shares of each volume
    std::uint64_t seed = 0;
};

/// Light that glowing volumes emit, and the part of it that the nodes of all volumes scatter.
/// `emitter` of a record is the number among glowing layouts, `volume` that among layouts. The same
/// bits for any number of threads; empty once the context is cancelled. Adds the rays traced to
/// `rays`.
formats::Glow bake_glow(const GlowJob& job, const Context& context, std::uint64_t& rays);

}  // namespace opaline::bake
