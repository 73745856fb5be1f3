#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/exchange/lamps/lamps.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Scatterings and surfaces met that the check takes at most.
inline constexpr double kLitMediaEvents = 2e6;

/// How far translucent receivers err under the light of emitters, model and numbers together.
struct LitMediaError {
    /// RMS of the error of luminance along the normals over the RMS of the truth, its noise taken
    /// off; no less than that noise.
    double rms_relative = 0;
    double bias = 0;   ///< mean error over mean truth; > 0: the file is too bright
    double noise = 0;  ///< RMS standard error of the truth, relative to its RMS
    std::uint32_t receivers_checked = 0;  ///< 0: there are none, or no truth of their light
    std::uint32_t samples = 0;            ///< paths of each
};

/// Compares `asset`, baked from `scene`, whose bodies face outward, with path tracing of light of
/// its emitters on whatever path, all as authored: at translucent receivers drawn at random. Where
/// a boundary refracts, paths find no light without a surface: such lamps are left out on both
/// sides. It shares nothing with the bake but what reference/ does. Errors: resource, interrupted.
formats::Result<LitMediaError> check_lit_media(const formats::Scene& scene,
                                               const formats::AssetView& asset,
                                               std::span<const Lamp> lamps, std::uint64_t seed,
                                               const Context& context);

}  // namespace opaline::bake
