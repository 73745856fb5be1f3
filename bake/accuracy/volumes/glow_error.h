#pragma once

#include <cstdint>

#include "bake/accuracy/volumes/volume_error.h"

namespace opaline::bake {

/// Error of the light that volumes send out by themselves: luminance along rays, seen directly and
/// scattered, by the runtime's march, against path tracing.
struct GlowErrorReport {
    double rms_relative = 0;         ///< RMS of the error over that of the truth, noise subtracted
    double bias = 0;                 ///< mean difference over mean truth
    double noise = 0;                ///< RMS standard error of the truth over its RMS
    std::uint32_t rays_checked = 0;  ///< 0: nothing was checked
    std::uint64_t events = 0;        ///< of all paths
};

/// The volumes of `asset`, baked from `scene`, through the rays of its check (check_volumes).
/// Surfaces are black on both sides. The same bits for any number of threads. Errors: resource,
/// interrupted.
formats::Result<GlowErrorReport> check_glow(const formats::Scene& scene,
                                            const formats::AssetView& asset,
                                            const VolumeCheckOptions& options,
                                            const Context& context);

}  // namespace opaline::bake
