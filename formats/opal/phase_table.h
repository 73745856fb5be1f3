#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace opaline::formats {

/// A phase function as `VOLU` keeps it: kPhaseEntries values [1/sr], linear in `phase_coordinate`
/// between. Even steps of the cosine would be coarse where it is near 1 or -1 and phase functions
/// have their peaks: at 1 a step of 1/128 is 7 degrees wide. Here steps are 0.6 to 0.9 degrees
/// wide everywhere, and finding the place takes one square root.
inline constexpr std::size_t kPhaseEntries = 257;

/// Where a cosine stands among the entries, in [0, 256]: 128 sqrt(1 + c) for c < 0, otherwise
/// 256 - 128 sqrt(1 - c). Cosines outside [-1, 1] count as the nearest in it, NaN as -1.
inline float phase_coordinate(float cosine) {
    if (cosine >= 0) return 256.0f - 128.0f * std::sqrt(std::max(0.0f, 1.0f - cosine));
    return 128.0f * std::sqrt(std::max(0.0f, 1.0f + cosine));
}

/// Its inverse; `coordinate` in [0, 256].
inline double phase_cosine(double coordinate) {
    const double end = (coordinate < 128 ? coordinate : 256 - coordinate) / 128;
    return coordinate < 128 ? end * end - 1 : 1 - end * end;
}

/// p' [1/sr] at a cosine between propagation directions. Precondition: kPhaseEntries entries.
inline float eval_phase_table(std::span<const float> table, float cosine) {
    const float at = phase_coordinate(cosine);
    const auto i = std::min(static_cast<std::size_t>(at), kPhaseEntries - 2);
    const float weight = at - static_cast<float>(i);
    return (1 - weight) * table[i] + weight * table[i + 1];
}

/// 2 pi int p' dcos, exact for the table as it is evaluated; 1 for a phase function.
double integrate_phase_table(std::span<const float> table);

}  // namespace opaline::formats
