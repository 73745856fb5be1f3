#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bake/check/volumes/volume_error.h"
#include "bake/effects/volumes/bake_volumes.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/effects/volumes/sent_light.h"
#include "bake/effects/volumes/volume_parts.h"
#include "bake/effects/volumes/volume_work.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/lamps/lamps.h"
#include "bake/pipeline/pipeline.h"
#include "bake/plan/knobs.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Warns where the error of volumes exceeds the target or, without one, the lower end of its
/// interval exceeds acceptable_error.
void warn_of_volumes(const Knobs& knobs, const std::optional<VolumeErrorReport>& error,
                     std::vector<formats::Diagnostic>& warnings);

/// What the stages of volumes work on.
struct VolumeStages {
    const EffectTable& effects;
    const formats::Scene& scene;
    const RayScene& rays;                   ///< surfaces; may be empty
    const BounceLight* surfaces = nullptr;  ///< what they send to volumes; null: nothing
    std::span<const Lamp> lamps = {};       ///< of the file
};

/// Volumes of one quality, and how far they err.
struct BakedVolumes {
    Knobs knobs;
    VolumePlan plan;
    VolumeParts parts;  ///< of the plan's layouts
    formats::Volumes volumes;
    VolumeFindings findings;
    std::optional<VolumeErrorReport> error;  ///< nothing: they scatter no light
    std::optional<GlowErrorReport> glow;     ///< nothing: none is an emitter
    std::optional<GlowErrorReport> lamps;    ///< nothing: none lights them
    std::vector<VolumeTrial> trials;         ///< where an error was asked for, in their order
};

/// Effort of the check of a bake's volumes: with Knobs::check_model until the noise is small;
/// otherwise as many events as take about a twelfth of the bake's time, at least 200 000.
/// `works`: of the layouts.
VolumeCheckOptions volume_check_effort(std::span<const VolumeWork> works,
                                       std::span<const VolumeLayout> layouts, const Knobs& knobs);

/// Times as many events for light of lamps, where paths near them are rare and bright.
inline constexpr std::uint64_t kEventsOfLamps = 4;

/// The presets' values of all volumes' knobs that the user did not give, and the quality that
/// their plan goes by.
Knobs with_volume_quality(const EffectTable& effects, Knobs knobs, Quality quality);

/// A scene's volumes, lit by the sky and by its surfaces, and their errors. With
/// Knobs::error_target they are baked in quality after quality, `draft` first, until the measured
/// error is below the target or falls by less than a tenth; the best bake so far is kept. Errors:
/// as bake_volumes and check_volumes; interrupted.
formats::Result<BakedVolumes> bake_and_measure(const VolumeStages& inputs, const Knobs& knobs,
                                               const Context& context, StageLog& log);

/// What was chosen for an error, so that the same options give the same bake again.
void keep_knobs(const EffectTable& effects, const BakedVolumes& baked, Knobs& knobs);

/// Whether volumes make the light of surfaces differ between the three bands.
bool colours_surfaces(const formats::Scene& scene, std::span<const VolumeLayout> layouts);

/// What they scatter to surfaces; nothing: none. Points into the arguments.
std::optional<SentLight> find_sent_light(const VolumeStages& inputs, const BakedVolumes& baked,
                                         const Knobs& knobs);

/// Adds a file's volumes to the result of its surfaces, and says how far they err.
void add_volumes(const formats::Scene& scene, BakedVolumes&& baked, BakeResult& result);

/// Gives light of volumes the numbers of the file's emitters. `lamps`: those that the file has;
/// volumes that are not among them come last.
void number_glow(std::span<const Lamp> lamps, BakeResult& result);

}  // namespace opaline::bake
