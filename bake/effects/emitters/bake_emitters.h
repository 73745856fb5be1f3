#pragma once

#include <span>

#include "bake/base/context.h"
#include "bake/base/stage_log.h"
#include "bake/effects/emitters/emitter_error.h"
#include "bake/effects/emitters/lit_media.h"
#include "bake/exchange/lamps/lamps.h"
#include "bake/plan/knobs.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/ray_scene.h"
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
    const BounceLight* surfaces = nullptr;  ///< that send light on, with arrivals; null: none does
    LitMedia media{};  ///< none: rows of translucent primitives have no light of emitters
    const ScenePyramids* textures = nullptr;  ///< BakeInputs::textures
    /// What is baked of the scene's volumes. Their records of GLOW have volumes that glow by
    /// Lamp::glow, and what is scattered of any other lamp e by first_scattered + e.
    formats::VolumesView volumes{};
    std::uint32_t first_scattered = 0;
};

struct BakedEmitters {
    formats::Emitters emitters;
    std::vector<std::string> immersed;  ///< lamps inside of media, whose light stays there
    EmitterErrorReport error;
};

/// The emitters of a file, and how far they err on opaque surfaces; four stages in the log, or
/// five where media are lit. The same bits for any number of threads. Errors: interrupted.
formats::Result<BakedEmitters> bake_emitters(const EmitterJob& job, const Context& context,
                                             StageLog& log);

}  // namespace opaline::bake
