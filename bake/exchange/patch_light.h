#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/scatterers.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Irradiance 1 on one patch of a medium's surface at a time: a column for each patch.
struct PatchLight {
    /// A place is in the patch of the scatterer nearest to it that faces its way, whatever its
    /// material.
    struct Scatterers {
        std::span<const Scatterer> all;
        const BounceTree& tree;                  ///< of all
        std::span<const std::uint32_t> members;  ///< those of the media
        std::vector<std::uint32_t> materials;    ///< of these
    };
    /// A place is in the patch of the receiver nearest to where a ray straight down meets the
    /// medium; in none if it meets something else.
    struct Receivers {
        const formats::Scene& scene;
        const RayScene& rays;
        std::span<const std::uint32_t> primitives;  ///< of the medium
        std::span<const std::uint32_t> first;       ///< of each, its first receiver
    };
    std::variant<Scatterers, Receivers> points;
    std::span<const std::uint32_t> patch;  ///< of each scatterer or receiver
};

/// Adds the irradiance at a place, one band. Returns the rays traced.
std::uint64_t add_patch(const PatchLight& light, const Receiver& at, std::span<float> row);

}  // namespace opaline::bake
