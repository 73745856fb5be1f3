#pragma once

#include <cstdint>

#include "bake/base/context.h"
#include "bake/effects/emitters/true_irradiance.h"

namespace opaline::bake {

/// How far rows of emitters err.
struct EmitterErrorReport {
    /// RMS of the error of luminance over the RMS of the truth, of all emitters as authored
    /// together, the noise of the truth taken off; no less than what the check can resolve, which
    /// is the standard error of the mean square.
    double rms_relative = 0;
    std::uint32_t receivers_checked = 0;
};

/// Compares the first row of receivers drawn at random, opaque ones, with path tracing.
/// Receivers in creases, with a surface nearer than a thousandth of the scene, are left out: there
/// paths lose their way in rounding. Precondition: at least one source.
EmitterErrorReport check_emitters(const EmitterCheck& check, std::uint64_t seed,
                                  const Context& context, std::uint64_t& rays);

}  // namespace opaline::bake
