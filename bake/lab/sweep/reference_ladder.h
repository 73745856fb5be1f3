#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/reference/estimate.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The Monte Carlo reference with a given number of samples.
struct ReferenceRung {
    std::uint32_t samples = 0;  ///< for each receiver
    double seconds = 0;         ///< of all of them
    double error = 0;   ///< measured: RMS of the difference from the truth, over the truth's RMS
    double stated = 0;  ///< predicted from the stored variance
};

struct ReferenceLadder {
    std::string light;
    std::uint32_t receivers = 0;
    std::uint32_t truth_samples = 0;   ///< of an independent estimate, for each receiver
    std::vector<ReferenceRung> rungs;  ///< from few samples to many
};

struct ReferenceLadderOptions {
    double seconds = 10;        ///< about; the first two rungs are climbed if `most_seconds` allow,
                                ///< of 16 receivers where there is no time for 256
    double most_seconds = 1e9;  ///< nothing where the first two rungs are predicted to take more
    std::uint32_t most_samples = 65536;  ///< nor are there more than these, for each receiver
    std::uint64_t seed = 0;
};

/// Estimates the radiance of vertices along their normals with 4, 16, 64, ... samples; each rung
/// contains the samples of the one before. The truth has twice as many, independent samples, and
/// its variance is subtracted. Nothing if no light reaches the receivers, or time is short. Errors:
/// resource, interrupted.
formats::Result<std::optional<ReferenceLadder>> climb_reference(
    const formats::Scene& scene, const ReferenceLadderOptions& options, const Context& context);

/// Error of a rung against a truth of other samples, receiver by receiver.
ReferenceRung compare_rung(const std::vector<Moments>& rung, const std::vector<Moments>& truth);

}  // namespace opaline::bake
