#pragma once

#include <span>

#include "bake/base/context.h"
#include "bake/base/stage_log.h"
#include "bake/emitters/emitter_error.h"
#include "bake/emitters/lamps.h"
#include "bake/plan/knobs.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/ray_scene.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// What emitters are baked from.
struct EmitterJob {
    const formats::Scene& scene;
    const RayScene& rays;  ///< all triangles
    std::span<const ReceiverSet> receivers;
    std::span<const formats::PrimitiveRecord> primitives;  ///< of the file: their rows
    std::span<const Lamp> lamps;                           ///< at least one
    const Knobs& knobs;
};

struct BakedEmitters {
    formats::Emitters emitters;
    EmitterErrorReport error;
};

/// The emitters of a file, and how far they err; three stages in the log. Opaque and thin-walled
/// primitives are lit; rows of translucent ones have no light of emitters. The same bits for any
/// number of threads. Errors: interrupted.
formats::Result<BakedEmitters> bake_emitters(const EmitterJob& job, const Context& context,
                                             StageLog& log);

}  // namespace opaline::bake
