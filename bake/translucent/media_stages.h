#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "bake/translucent/translucent_rows.h"

namespace opaline::bake {

/// The stages that the receivers of one medium share, and the recipe that uses them. The recipe
/// points into its owner: not to be copied.
struct MediumStages {
    std::optional<MultipleStage> multiple;
    std::optional<SingleStage> single;
    std::optional<LocalStage> local;  ///< instead of the others
    TranslucentRecipe recipe;
};

/// Profiles of the media whose multiple scattering is simulated, by material.
using MediaProfiles = std::map<std::uint32_t, MediumProfile>;

/// By material.
using MediaStages = std::map<std::uint32_t, MediumStages>;

}  // namespace opaline::bake
