#pragma once

#include <vector>

#include "bake/base/context.h"
#include "bake/base/stage_log.h"
#include "bake/effects/volumes/choose_method.h"
#include "bake/effects/volumes/place_nodes.h"
#include "bake/effects/volumes/walk_nodes.h"
#include "formats/opal/result.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {

/// Memory [bytes] that the attenuated light of all nodes may take while walks look it up.
inline constexpr double kDepthBytes = 4e9;

/// What a bake of volumes finds out about itself.
struct VolumeFindings {
    std::vector<MethodMeasure> methods;  ///< of layouts that were automatic
    std::vector<RowNoise> noise;         ///< of layouts whose rows were smoothed
};

/// The volumes of a file: density, nodes and their rows; two stages in the log, three where
/// surfaces send light to them. `findings`: null where not wanted. The same bits for any number of
/// threads. Empty once the context is cancelled. Errors: resource (more nodes, bricks or
/// coefficients than fit), bad_input (a row that is not finite).
formats::Result<formats::Volumes> bake_volumes(const VolumeJob& job, const Context& context,
                                               StageLog& log, VolumeFindings* findings = nullptr);

}  // namespace opaline::bake
