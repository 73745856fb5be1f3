#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/check/measure_error.h"
#include "bake/check/model_pairs.h"
#include "bake/effects/layers/layer_error.h"
#include "bake/lab/sweep/ladders.h"
#include "bake/lab/sweep/probes.h"
#include "bake/pipeline/pipeline.h"
#include "formats/opal/clouds.h"
#include "formats/opal/environment.h"
#include "formats/scene.h"
#include "runtime/picture/picture.h"

namespace opaline::bake {

/// 0 for presets, 1 for choices, which presets may have made, 3 for joint ladders, else 2.
int urgency(const SweepPoint& point);

/// Urgent points first, of those the cheap ones: they give the most information per second.
/// `seconds`: predicted; asked once for each point.
void order_points(std::vector<SweepPoint>& points,
                  const std::function<double(const SweepPoint&)>& seconds);

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

/// The lights of one cube map size: those that bakes check themselves under, and those of the path
/// tracing (ModelProbes::lights).
struct SweepLights {
    ProbeLights probes;
    std::vector<runtime::LightVector> model;
};

/// The result of one point.
struct PointRecord {
    SweepPoint point;
    double seconds = 0;      ///< of the whole bake, its self-check included
    double cpu_seconds = 0;  ///< of all threads together; other programs do not count
    StageGroups groups;
    StageLog stages;
    std::uint64_t bytes = 0;       ///< of the file
    std::uint64_t peak_bytes = 0;  ///< largest resident memory during the bake
    ErrorReport error;             ///< of the numbers, as the bake measured it; of volumes, if
                                   ///< larger, against path tracing
    VolumeErrorReport volumes;     ///< of volumes, against path tracing along SweepVolumes' rays
    std::optional<LayerErrorReport> layer;  ///< of a cloud layer's tables
    std::string choices;         ///< of its plan (list_choices); only equal ones differ in numbers
                                 ///< alone
    std::size_t finest = 0;      ///< index of the finest point of the same choices
    ErrorReport against_finest;  ///< from that one, at all probes, and its own error added in
                                 ///< squares
    ModelErrorReport total;      ///< of model and numbers, against path tracing
    std::vector<double> luminance;                     ///< relight_probes
    std::vector<double> volume_luminance;              ///< relative_luminance
    std::vector<double> layer_radiance;                ///< read_layer_radiance, at last scaled
    std::vector<std::vector<double>> model_luminance;  ///< relight_receivers, light by light
    runtime::Picture picture;                          ///< empty where none was wanted
};

/// Probes, lights and camera shared by all points.
struct SweepView {
    std::vector<std::uint32_t> probes;
    ModelProbes model;
    SweepVolumes volumes;
    formats::Environment picture_light;
    std::uint32_t picture_width = 480, picture_height = 360;
};

/// Bakes and measures; the asset itself is dropped. What needs a truth is left for later. Errors:
/// as run_bake and render_software.
formats::Result<PointRecord> run_point(const EffectTable& effects, const formats::Scene& scene,
                                       const SweepPoint& point, const SweepView& view,
                                       const SweepLights& lights, const Context& context);

/// Radiance of the light that a layer's droplets scatter [1/sr], per irradiance facing the light,
/// as its tables give it: at optical depths, lights, views, azimuths, sides and bands that are the
/// same for all bakes. Of all layers; places of one group (depth, light, side, band) follow each
/// other.
std::vector<double> read_layer_radiance(const formats::CloudsView& clouds);

/// Divides the layers' radiances of all points by the RMS of their group in the first one: groups
/// then count alike, as they do in LayerErrorReport. Precondition: of the same scene.
void scale_layer_radiance(std::span<PointRecord> points);

/// A bake's error is the larger one, of surfaces and volumes or of its layer.
void take_larger(ErrorReport& error, const LayerErrorReport& layer);

}  // namespace opaline::bake
