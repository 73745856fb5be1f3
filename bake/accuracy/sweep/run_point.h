#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/accuracy/measure_error.h"
#include "bake/accuracy/sweep/ladders.h"
#include "bake/accuracy/sweep/probes.h"
#include "bake/base/context.h"
#include "bake/pipeline/pipeline.h"
#include "formats/opal/environment.h"
#include "formats/scene.h"
#include "runtime/picture/picture.h"

namespace opaline::bake {

/// Seconds of a bake by the groups of its stages (StageReport::group), in the order in which they
/// first ran.
struct GroupSeconds {
    std::string name;
    double seconds = 0;
};
using StageGroups = std::vector<GroupSeconds>;
/// Seconds between stages count as preparation: the groups add up to `seconds_total`.
StageGroups group_stages(const StageLog& stages, double seconds_total);
/// Of a group; 0 where there is none of that name.
double seconds_of(const StageGroups& groups, const std::string& name);

/// The result of one point.
struct PointRecord {
    SweepPoint point;
    double seconds = 0;      ///< of the whole bake, its self-check included
    double cpu_seconds = 0;  ///< of all threads together; other programs do not count
    StageGroups groups;
    StageLog stages;
    std::uint64_t bytes = 0;                      ///< of the file
    std::uint64_t peak_bytes = 0;                 ///< largest resident memory during the bake
    ErrorReport error;                            ///< as the bake measured it
    std::optional<ModelErrorReport> model_error;  ///< where the knobs ask for it
    ErrorReport against_finest;     ///< from the finest bake, at all probes, and that one's own
                                    ///< error added in squares
    std::vector<double> luminance;  ///< relight_probes
    runtime::Picture picture;       ///< empty where none was wanted
};

/// Probes, lights and camera shared by all points.
struct SweepView {
    std::vector<std::uint32_t> probes;
    formats::Environment picture_light;
    std::uint32_t picture_width = 480, picture_height = 360;
};

/// Bakes and measures; the asset itself is dropped. `error` is left for later, when the truth is
/// known. Errors: as run_bake and render_software.
formats::Result<PointRecord> run_point(const EffectTable& effects, const formats::Scene& scene,
                                       const SweepPoint& point, const SweepView& view,
                                       const ProbeLights& lights, const Context& context);

}  // namespace opaline::bake
