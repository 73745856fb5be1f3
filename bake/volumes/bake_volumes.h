#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/base/stage_log.h"
#include "bake/transport/ray_scene.h"
#include "bake/volumes/choose_method.h"
#include "bake/volumes/node_lattice.h"
#include "bake/volumes/plan_volumes.h"
#include "formats/opal/result.h"
#include "formats/opal/volumes.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What volumes are baked from.
struct VolumeJob {
    const formats::Scene& scene;
    const RayScene& rays;  ///< surfaces that stand before the light; may be empty
    std::span<const VolumeLayout> layouts;
    const Knobs& knobs;
};

/// Memory [bytes] that the attenuated light of all nodes may take while walks look it up.
inline constexpr double kDepthBytes = 4e9;

/// Where the light of a volume is baked.
NodeLattice lattice_of(const formats::Volume& volume, const VolumeLayout& layout);

/// The volumes of a file: density, nodes and their rows; two stages in the log. Layouts whose
/// method is automatic are measured first, into `measured` where it is not null. The same bits for
/// any number of threads. Empty once the context is cancelled. Errors: resource (more nodes, bricks
/// or coefficients than fit), bad_input (a row that is not finite).
formats::Result<formats::Volumes> bake_volumes(const VolumeJob& job, const Context& context,
                                               StageLog& log,
                                               std::vector<MethodMeasure>* measured = nullptr);

}  // namespace opaline::bake
