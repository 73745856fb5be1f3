#include "bake/lab/sweep/run_point.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <utility>

#include "bake/base/stage_log.h"
#include "bake/check/volumes/see_through.h"
#include "bake/check/volumes/volume_error.h"
#include "bake/effects/layers/layer_tables.h"
#include "formats/opal/write_opal.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/part_environments.h"
#include "runtime/part_lights.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/shade.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_bounds.h"

namespace opaline::bake {
namespace {

// Resets the kernel's peak counter, so that each bake has its own peak. Where that fails, peaks are
// those of the process so far.
void forget_peak_memory() {
    ::malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
}

// What of the light above reaches meshes and volumes, as `opaline render` has it.
runtime::PartEnvironments light_below(const formats::AssetView& asset,
                                      const runtime::LayerLight& layers,
                                      const formats::Environment& above, unsigned threads) {
    const runtime::BoundingSphere bound = runtime::bound_asset(asset);
    const formats::Vec3 centre{static_cast<float>(bound.x), static_cast<float>(bound.y),
                               static_cast<float>(bound.z)};
    return runtime::environments_of_parts({layers, above, {}}, asset,
                                          runtime::volume_corners(asset.volumes), centre, threads);
}

formats::Result<runtime::Picture> draw(const formats::AssetView& asset, const SweepView& view,
                                       unsigned threads) {
    // The default view of `opaline render`.
    constexpr float kFieldOfView = 32;
    const runtime::Camera camera =
        runtime::frame_asset(asset, kFieldOfView, view.picture_width, view.picture_height);
    std::optional<runtime::LayerLight> layers;
    if (!asset.clouds.empty()) {
        layers = runtime::light_layers(asset.clouds, view.picture_light, {}, {.threads = threads});
    }
    const bool has_objects = !asset.primitives.empty() || !asset.volumes.empty();
    runtime::PartEnvironments parts;
    if (layers && has_objects) {
        parts = light_below(asset, *layers, view.picture_light, threads);
    } else {
        parts.at_point.push_back(view.picture_light);
    }
    std::vector<runtime::LightVector> vectors;
    vectors.reserve(parts.at_point.size());
    for (const formats::Environment& environment : parts.at_point) {
        vectors.push_back(
            runtime::project_environment(environment, asset.cubemap_size, {}, threads));
    }
    const runtime::PartLights lights{vectors, parts.points.of_primitive, parts.points.of_volumes};
    const std::vector<formats::Rgb> radiance =
        runtime::shade_for_picture(asset, lights, camera.eye, formats::TermSet::all, threads);
    const runtime::SpecularNeeds needs = runtime::specular_needs(asset);
    const runtime::SpecularLight specular =
        runtime::make_specular_light(parts.mirrored(), needs, {}, threads);
    const runtime::VolumeLight volumes =
        runtime::relight_volumes(asset.volumes, vectors[lights.of_volumes], {.threads = threads});
    runtime::SoftwareOptions options;
    options.threads = threads;
    options.volumes = &volumes;
    options.lights = lights;
    options.layers = layers ? &*layers : nullptr;
    options.specular = needs.any() ? &specular : nullptr;
    return runtime::render_software(asset, radiance, view.picture_light, {}, camera, options);
}

// Between the nodes of tables of any size; from thin to thick, and as layer_error draws them.
constexpr std::array kDepths{0.4, 1.7, 6.3, 21.0};
constexpr std::array kLights{0.21, 0.47, 0.83};
constexpr std::array kViews{0.13, 0.37, 0.61, 0.91};
constexpr unsigned kAzimuths = 5;
constexpr std::size_t kGroup = kViews.size() * kAzimuths;

}  // namespace

StageGroups group_stages(const StageLog& stages, double seconds_total) {
    StageGroups groups{{kPreparationGroup, seconds_total}};
    for (const StageReport& stage : stages) {
        if (stage.group == kPreparationGroup) continue;
        const auto same = std::find_if(groups.begin(), groups.end(), [&](const GroupSeconds& g) {
            return g.name == stage.group;
        });
        if (same == groups.end()) {
            groups.push_back({stage.group, stage.seconds});
        } else {
            same->seconds += stage.seconds;
        }
        groups.front().seconds -= stage.seconds;
    }
    groups.front().seconds = std::max(0.0, groups.front().seconds);
    return groups;
}

double seconds_of(const StageGroups& groups, const std::string& name) {
    const auto found = std::find_if(groups.begin(), groups.end(),
                                    [&](const GroupSeconds& g) { return g.name == name; });
    return found == groups.end() ? 0 : found->seconds;
}

formats::Result<PointRecord> run_point(const EffectTable& effects, const formats::Scene& scene,
                                       const SweepPoint& point, const SweepView& view,
                                       const SweepLights& lights, const Context& context) {
    forget_peak_memory();
    const double cpu_before = cpu_seconds();
    const auto bake = run_bake(effects, scene, point.knobs, context);
    if (!bake) return bake.error();
    const double cpu_after = cpu_seconds();
    const formats::AssetView asset = bake->asset.view();
    PointRecord record;
    record.point = point;
    record.seconds = bake->seconds_total;
    record.cpu_seconds = cpu_after - cpu_before;
    record.groups = group_stages(bake->stages, bake->seconds_total);
    record.stages = bake->stages;
    record.bytes = formats::opal_size(asset, formats::Compression::fast);
    record.peak_bytes = bake->stages.empty() ? 0 : bake->stages.back().peak_rss_bytes;
    record.error = bake->error;
    // Knobs are compared: what a mesh is too coarse for is the same for all of them.
    static_cast<MeasuredError&>(record.error) = bake->error.at_receivers;
    if (!view.volumes.empty() && !asset.volumes.empty()) {
        const std::vector<double> marched = march_probes(
            asset.volumes, asset.cubemap_size, scene.origin, view.volumes.probes, context.threads);
        const std::vector<double> through = see_through_file(
            asset.volumes, asset.cubemap_size, scene.origin, view.volumes.probes, context.threads);
        record.volumes = compare_volumes(marched, through, view.volumes.truth, point.knobs.seed);
        record.volume_luminance = relative_luminance(view.volumes, marched);
        take_larger(record.error, as_error_report(record.volumes));
    }
    record.layer = bake->layer_error;
    if (record.layer) {
        take_larger(record.error, *record.layer);
        record.layer_radiance = read_layer_radiance(asset.clouds);
    }
    record.choices = list_choices(bake->plan);
    record.luminance = relight_probes(asset, view.probes, lights.probes);
    for (const runtime::LightVector& light : lights.model) {
        record.model_luminance.push_back(
            relight_receivers(asset, view.model.receivers, {.vector = light}));
    }
    auto picture = draw(asset, view, context.threads);
    if (!picture) return std::move(picture).error();
    record.picture = std::move(*picture);
    return record;
}

int urgency(const SweepPoint& point) {
    const auto stands_on = [&](Ladder ladder) {
        return std::any_of(point.rungs.begin(), point.rungs.end(),
                           [&](const Rung& r) { return r.ladder == ladder; });
    };
    const Ladder& first = point.rungs.front().ladder;
    return stands_on(Ladders::preset)                            ? 0
           : first.knob != nullptr && !first.knob->words.empty() ? 1
           : first == Ladders::grid                              ? 3
                                                                 : 2;
}

void order_points(std::vector<SweepPoint>& points,
                  const std::function<double(const SweepPoint&)>& seconds) {
    std::vector<std::pair<double, SweepPoint>> costed;
    for (SweepPoint& point : points) {
        const double cost = seconds(point);
        costed.emplace_back(cost, std::move(point));
    }
    std::ranges::stable_sort(costed, {}, [](const auto& one) {
        return std::pair{urgency(one.second), one.first};
    });
    points.clear();
    for (auto& [cost, point] : costed) {
        points.push_back(std::move(point));
    }
}

std::vector<double> read_layer_radiance(const formats::CloudsView& clouds) {
    std::vector<double> radiance;
    for (const formats::LayerRecord& record : clouds.records) {
        for (std::size_t band = 0; band < record.band.size(); ++band) {
            const StoredTables tables = read_tables(clouds, record, band);
            for (const double depth : kDepths) {
                for (const double light : kLights) {
                    for (const bool transmitted : {false, true}) {
                        for (std::size_t i = 0; i < kGroup; ++i) {
                            const double azimuth = std::numbers::pi / kAzimuths *
                                                   (static_cast<double>(i % kAzimuths) + 0.4);
                            radiance.push_back(eval_scattered(
                                tables, depth, light, kViews[i / kAzimuths], azimuth, transmitted));
                        }
                    }
                }
            }
        }
    }
    return radiance;
}

void scale_layer_radiance(std::span<PointRecord> points) {
    if (points.empty()) return;
    std::vector<double> scale;
    const std::vector<double>& first = points.front().layer_radiance;
    for (std::size_t begin = 0; begin + kGroup <= first.size(); begin += kGroup) {
        double square = 0;
        for (std::size_t i = begin; i < begin + kGroup; ++i) {
            square += first[i] * first[i] / static_cast<double>(kGroup);
        }
        scale.push_back(square > 0 ? 1 / std::sqrt(square) : 0);
    }
    for (PointRecord& point : points) {
        for (std::size_t i = 0; i < point.layer_radiance.size(); ++i) {
            point.layer_radiance[i] *= scale[i / kGroup];
        }
    }
}

void take_larger(ErrorReport& error, const LayerErrorReport& layer) {
    if (error.receivers_checked == 0 || layer.rms_relative > error.rms_relative) {
        error.rms_relative = layer.rms_relative;
        std::ranges::copy(layer.ci95, error.ci95);
        error.max_relative = layer.worst;
    }
    if (error.receivers_checked > 0) {
        error.reference += "; clouds: " + layer.reference;
    }
    error.receivers_checked += layer.radiances_checked;
}

}  // namespace opaline::bake
