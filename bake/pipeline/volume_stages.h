#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bake/accuracy/volumes/volume_error.h"
#include "bake/lamps/lamps.h"
#include "bake/pipeline/pipeline.h"
#include "bake/plan/knobs.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/ray_scene.h"
#include "bake/volumes/plan_volumes.h"
#include "bake/volumes/volume_work.h"
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
    const RayScene& rays;                    ///< surfaces; may be empty
    std::span<const ReceiverSet> receivers;  ///< in the order of the scene's primitives
    std::span<const RowLayout> layouts;      ///< by material
};

/// Effort of the check of a bake's volumes: with Knobs::check_model until the noise is small;
/// otherwise as many events as take about a twelfth of the bake's time, at least 200 000.
/// `works`: of the layouts.
VolumeCheckOptions volume_check_effort(std::span<const VolumeWork> works,
                                       std::span<const VolumeLayout> layouts, const Knobs& knobs);

/// The presets' values of all volumes' knobs that the user did not give, and the quality that
/// their plan goes by.
Knobs with_volume_quality(const EffectTable& effects, Knobs knobs, Quality quality);

/// Adds a file's volumes to `result`, lit by the sky and by the file's surfaces, measures them,
/// dims the rows of surfaces by them, and adds the light that they scatter to surfaces. With
/// Knobs::error_target they are baked in quality after quality, `draft` first, until the measured
/// error is below the target or falls by less than a tenth; the best bake so far is kept, and
/// `result.knobs` has its values. Errors: as bake_volumes and check_volumes; interrupted.
formats::Status add_volumes(const VolumeStages& inputs, const Context& context, BakeResult& result);

/// Gives light of volumes the numbers of the file's emitters. `lamps`: those that the file has;
/// volumes that are not among them come last.
void number_glow(std::span<const Lamp> lamps, BakeResult& result);

}  // namespace opaline::bake
