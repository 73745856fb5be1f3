#pragma once

#include <cstdint>
#include <span>

#include "bake/accuracy/measure_error.h"
#include "bake/rows/subject_states.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// What a finished file was baked from.
struct FinishedBake {
    const BakeInputs& inputs;
    std::span<const SubjectState> subjects;
    const Knobs& knobs;
    std::span<const TestLight> lights;  ///< of the asset's cube map
};

/// Compares the file with the truth, without base colour, at held-back receivers and at as many
/// random points of the surface, where the file is interpolated as the runtime does: each subject's
/// rows as a whole, under the lights as they are. Seen along the normal; where walks hold light of
/// all orders, a quarter of the points so and the others from elsewhere (turn_views). `traced` adds
/// up.
ErrorReport check_file(const FinishedBake& bake, const formats::AssetView& asset,
                       const Context& context, std::uint64_t& traced);

}  // namespace opaline::bake
