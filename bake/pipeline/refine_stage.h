#pragma once

#include <cstdint>
#include <optional>

#include "bake/base/context.h"
#include "bake/base/stage_log.h"
#include "bake/plan/effect.h"
#include "bake/plan/knobs.h"
#include "bake/refine/refine_scene.h"
#include "bake/refine/share_copies.h"
#include "bake/refine/simplify_scene.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// How far the knobs have receivers added to a scene of so many.
RefineLimits refine_limits(const Knobs& knobs, std::uint64_t receivers);

/// The knobs with RefineChoice::max_receivers lowered to what is predicted to fit into `memory`
/// [bytes]; as they are where nothing is refined.
Knobs fit_refinement(const EffectTable& effects, const formats::Scene& scene, Knobs knobs,
                     unsigned threads, std::uint64_t memory);

/// Decides which copies of a scene share rows (share_copies.h); none where Knobs::simplify is off.
/// Those that do not are to be expanded. Errors: resource.
formats::Result<ShareReport> share_copies_for_bake(const Knobs& knobs, const Context& context,
                                                   formats::Scene& scene);

/// A warning where the limit of receivers ended it; nothing where it did not.
std::optional<formats::Diagnostic> describe_bound(const RefineReport& report);

/// The scene with the receivers that its light needs; of media whose bodies face outward.
/// Errors: resource.
formats::Result<RefinedScene> refine_for_bake(const formats::Scene& scene, const Knobs& knobs,
                                              const Context& context, StageLog& log);

/// Which vertices of a refined scene share rows, and which need none (Knobs::simplify). Errors:
/// resource.
formats::Result<SimplifiedScene> simplify_for_bake(const formats::Scene& scene, const Knobs& knobs,
                                                   const Context& context, StageLog& log);

}  // namespace opaline::bake
