#pragma once

#include <cstdint>
#include <span>

#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/exchange_points.h"
#include "bake/exchange/scatterer_light.h"
#include "bake/exchange/scatterers.h"
#include "bake/exchange/series_end.h"

namespace opaline::bake {

/// Solves B = B_0 + K B for all columns of the sky at once, by following bounces until what comes
/// after them is known: the tree's rows become all light that scatterers send out. `light`: B_0,
/// completed by light of the sky that crosses media straight. `media`: as its answers. Shares of a
/// scatterer's rays and its sky add up to 1. Counts `rays`.
SolveReport add_bounces(const LightInputs& inputs, std::span<const Scatterer> scatterers,
                        std::span<const MediumRows> media, ScattererLight& light, BounceTree& tree,
                        std::uint64_t& rays);

/// The tree's rows become B_0 alone, completed likewise.
void set_unbounced(const LightInputs& inputs, std::span<const Scatterer> scatterers,
                   std::span<const MediumRows> media, ScattererLight& light, BounceTree& tree,
                   std::uint64_t& rays);

}  // namespace opaline::bake
