#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/exchange_points.h"
#include "bake/exchange/scatterer_light.h"
#include "bake/exchange/scatterers.h"
#include "bake/exchange/series_end.h"

namespace opaline::bake {

/// What reaches a scatterer from others, on its side and, through a sheet, on the other one; and
/// what of others' radiosity crosses its medium to it, as the mean of the bands.
struct Arrivals {
    std::vector<NodeWeight> front, back, through;
    BandColour of_through{};  ///< times `through`, by band
};

/// The arrivals of all scatterers: shares of a scatterer's rays and its sky add up to 1. `light`:
/// its B_0 is completed by light of the sky that crosses media straight or comes by way of narrow
/// lobes. `media`: as its answers.
/// `tree`: of the scatterers. Counts `rays`.
std::vector<Arrivals> weigh_scatterers(const LightInputs& inputs,
                                       std::span<const Scatterer> scatterers,
                                       std::span<const MediumRows> media, const BounceTree& tree,
                                       ScattererLight& light, std::uint64_t& rays);

/// How light goes from scatterer to scatterer: one operator K for light from anywhere.
struct Transfer {
    std::vector<Scatterer> scatterers;
    ScattererAnswers answers;
    std::vector<Arrivals> arrivals;
};

/// Solves B = B_0 + K B, for all columns at once, by following bounces until what comes after them
/// is known: the tree's rows become all light that scatterers send out. `emitted`: B_0, `bands`
/// planes of the columns of any light. The nodes of the tree are those of the arrivals.
SolveReport add_bounces(const Transfer& transfer, const CodedRows& emitted, std::uint32_t bands,
                        BounceTree& tree, const Context& context);

}  // namespace opaline::bake
