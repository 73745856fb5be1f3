#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/medium_answer.h"
#include "bake/exchange/scatterers.h"
#include "bake/plan/effect.h"
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

/// Where light is looked for that surfaces send to each other.
struct ExchangePoints {
    std::vector<Scatterer> scatterers;   ///< none where receivers see no surface
    std::vector<MediumAnswer> media{};   ///< those that scatterers lie on; their shares are 0
    std::optional<BounceTree> tree{};    ///< of scatterers, without rows, where there are media
    std::vector<std::uint32_t> patch{};  ///< of scatterers that lie on media

    std::uint32_t material_of(const MediumAnswer& medium, std::size_t member) const {
        return scatterers[medium.members[member]].material;
    }
    /// Irradiance 1 on one patch of a medium at a time. The points must outlive it.
    PatchLight light_of(const MediumAnswer& medium) const {
        PatchLight light{scatterers, *tree, medium.members, {}, patch};
        for (std::size_t m = 0; m < medium.members.size(); ++m) {
            if (m == 0 || material_of(medium, m) != material_of(medium, m - 1)) {
                light.materials.push_back(material_of(medium, m));
            }
        }
        return light;
    }
};

/// Counts `rays`.
ExchangePoints place_exchange(const LightInputs& inputs, std::uint64_t& rays);

/// What effects say of one answer, at its members in their order. All may be empty, and so may be
/// rows of members for which no effect says anything.
struct MediumRows {
    /// T_k, terms * bands * 6 n n values each, n = kBounceCubemap: of light on one patch at a time
    /// what it scatters, and of the environment's what crosses it straight.
    std::vector<std::vector<float>> scattered, crossing;
    std::vector<CrossingViews> through;  ///< which surfaces are seen where that crosses
};

}  // namespace opaline::bake
