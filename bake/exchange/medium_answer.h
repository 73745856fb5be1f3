#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/scatterers.h"
#include "bake/plan/effect.h"
#include "bake/trace/coded_rows.h"

namespace opaline::bake {

/// By band; of one band the first.
using BandColour = std::array<float, 3>;

/// Three bands as they are, or their luminance.
BandColour in_bands(const BandColour& colour, std::uint32_t bands);

/// What scatters back out of a medium, or of several that meet or lie in each other: one operator
/// for light of the sky and of other surfaces, so that no light is created between them. Light that
/// enters a patch of the surface leaves every patch with a share of it. Shares of what arrives at
/// once everywhere add up to no more than what enters, 1 - F_ext: with K of the rays between
/// surfaces, whose shares add up to 1, no surface is brighter than the sky around it.
struct MediumAnswer {
    std::vector<std::uint32_t> members;  ///< scatterers on it, material by material
    std::vector<std::uint32_t> patch;    ///< of each of them
    std::vector<float> part;             ///< of each of them: its share of its patch's area
    std::uint32_t patches = 0;
    /// Exitance of patch `to` by irradiance 1 on patch `from`, but for the base colour: to *
    /// patches + from. Of what scatters; what crosses the body straight is no part of it.
    std::vector<BandColour> share;

    /// Exitance by irradiance 1 on all patches.
    BandColour sum_of(std::uint32_t to) const;
};

/// Patches of one answer, at most: columns of the rows that say what it answers.
inline constexpr std::uint32_t kMostPatches = 6 * kBounceCubemap * kBounceCubemap;

/// The scatterers `members`, material by material, in patches of one material each; its shares are
/// 0. `cells`: areas of all scatterers [m^2].
MediumAnswer cut_medium(std::span<const Scatterer> scatterers, std::span<const float> cells,
                        std::vector<std::uint32_t> members);

/// Sets its shares from rows that effects make at its members of light on one patch each; they
/// stay 0 where no effect scatters.
void set_shares(const LightInputs& inputs, std::span<const Scatterer> scatterers,
                std::span<const std::vector<float>> rows, MediumAnswer& answer);

/// Adds what the medium makes of irradiance to rows of radiosity,
///     B_i += c_i (A_pp E_i + sum over other patches q of A_pq E_q),   p the patch of i,
/// E_q the mean over the patch: within its own patch a point answers what arrives at it. Rows, of
/// all scatterers: `bands` planes of any columns; others' stay as they are.
void add_answer(const MediumAnswer& answer, std::span<const Scatterer> scatterers,
                const CodedRows& irradiance, std::uint32_t bands, const Context& context,
                CodedRows& radiosity);

}  // namespace opaline::bake
