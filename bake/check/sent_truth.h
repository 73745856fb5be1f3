#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "bake/check/measure_error.h"
#include "bake/check/subject_truth.h"
#include "bake/effects/volumes/sent_light.h"

namespace opaline::bake {

/// What volumes scatter to points of one subject, for the check of its rows: from the nodes that
/// the file has, whose own error is that of volumes, by four times the rays.
struct SentTruth {
    std::array<SentLight, 2> light;  ///< for two independent estimates
    const formats::Material& material;
    std::uint32_t cubemap_size = 0;    ///< of the lights
    std::optional<SubjectTruth> even;  ///< of a medium under even light that no volume dims
};
/// `bake` must outlive the result.
SentTruth make_sent_truth(const FinishedBake& bake, const SentLight& light,
                          const SubjectState& subject, const Context& context);

/// Adds the luminance of that light. Returns the rays traced.
std::uint64_t add_sent_truth(const SentTruth& truth, const TruthReceiver& at,
                             std::span<const TestLight> lights, TwoEstimates& luminance);

}  // namespace opaline::bake
