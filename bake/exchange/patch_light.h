#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/scatterers.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Irradiance 1 on one patch of a medium's surface at a time: a column for each patch. A place is
/// in the patch of the scatterer nearest to it that faces its way, whatever its material.
struct PatchLight {
    std::span<const Scatterer> scatterers;
    const BounceTree& tree;                  ///< of all scatterers
    std::span<const std::uint32_t> members;  ///< those of the media
    std::vector<std::uint32_t> materials;    ///< of these
    std::span<const std::uint32_t> patch;    ///< of each scatterer
};

/// Adds the irradiance at a place, one band.
void add_patch(const PatchLight& light, const Receiver& at, std::span<float> row);

}  // namespace opaline::bake
