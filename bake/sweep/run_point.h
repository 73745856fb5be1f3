#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/measure/measure_error.h"
#include "bake/pipeline.h"
#include "bake/sweep/ladders.h"
#include "bake/sweep/probes.h"
#include "formats/opal/environment.h"
#include "formats/scene.h"
#include "runtime/picture/picture.h"

namespace opaline::bake {

/// Seconds of a bake by what they went into, in the order of stage_group_names().
using StageGroups = std::vector<double>;
std::span<const std::string_view> stage_group_names();
/// `asset` tells which rows are of media. Stages the names of which are not known count as
/// preparation, like the seconds between stages: the groups add up to `seconds_total`.
StageGroups group_stages(const BakeResult& bake);

/// What came of one point.
struct PointRecord {
    SweepPoint point;
    double seconds = 0;      ///< of the whole bake, its self-check included
    double cpu_seconds = 0;  ///< of all threads together; other programs do not count
    StageGroups groups;
    std::vector<StageReport> stages;
    std::uint64_t bytes = 0;                      ///< of the file
    std::uint64_t peak_bytes = 0;                 ///< largest resident memory during the bake
    ErrorReport error;                            ///< as the bake measured it
    std::optional<ModelErrorReport> model_error;  ///< where the knobs ask for it
    ErrorReport against_finest;     ///< from the finest bake, at all probes, and that one's own
                                    ///< error added in squares
    std::vector<double> luminance;  ///< relight_probes
    runtime::Picture picture;       ///< empty where none was wanted
};

/// What all points are looked at with.
struct SweepView {
    std::vector<std::uint32_t> probes;
    formats::Environment picture_light;
    std::uint32_t picture_width = 480, picture_height = 360;
};

/// Bakes and measures; the asset itself is dropped. `error` is left for later, when the truth is
/// known. Errors: as run_bake and render_software.
formats::Result<PointRecord> run_point(const formats::Scene& scene, const SweepPoint& point,
                                       const SweepView& view, const ProbeLights& lights,
                                       const Context& context);

}  // namespace opaline::bake
