#pragma once

#include "bake/physics/path_integral/volume_box.h"
#include "bake/physics/phase_series.h"

namespace opaline::bake {

/// A phase function as a peak that does not turn light, and a smooth rest [Wiscombe1977]:
/// p = share delta + (1 - share) rest.
struct ForwardSplit {
    double share = 0;  ///< in [0, 1)
    PhaseSeries rest;  ///< degrees 0 to N, tail 0; may be negative somewhere
};

/// The split at degree N: share = lambda_(N+1), rest lambda'_l = (lambda_l - share) / (1 - share).
/// All moments up to N of light that is scattered any number of times are those of the whole phase
/// function. lambda_(N+1) <= 0 is no peak: the share is 0. Precondition: N + 2 degrees or more, and
/// lambda_(N+1) < 1.
ForwardSplit split_forward_peak(const PhaseSeries& series, unsigned degree);

/// What the rest does to light, the peak counted as not scattered: b' = b (1 - share),
/// c' = c - share b. The absorption stays. `share` in [0, 1).
inline Coefficients without_peak(Coefficients medium, double share) {
    return {medium.scattering * (1 - share), medium.absorption};
}

}  // namespace opaline::bake
