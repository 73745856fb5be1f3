#include "bake/sweep/run_point.h"

#include <malloc.h>
#include <sys/resource.h>

#include <array>
#include <fstream>
#include <utility>

#include "formats/opal/write_opal.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/shade.h"

namespace opaline::bake {
namespace {

enum Group : std::size_t { preparation, direct, samples, light_maps, medium_rows, openness, check };

constexpr std::array<std::string_view, 7> kGroupNames{
    "preparation", "direct: rows",       "multiple: samples", "single: light maps",
    "media: rows", "specular: openness", "self-check"};

bool starts_with(const std::string& text, std::string_view start) {
    return text.compare(0, start.size(), start) == 0;
}

// The kernel counts the peak anew, so that each bake of a process has its own. Where it does not,
// peaks are those of the process so far.
void forget_peak_memory() {
    ::malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
}

// Of the whole process so far.
double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

formats::Result<runtime::Picture> draw(const formats::AssetView& asset, const SweepView& view,
                                       unsigned threads) {
    // The default view of `opaline render`.
    constexpr float kFieldOfView = 32;
    const runtime::Camera camera =
        runtime::frame_asset(asset, kFieldOfView, view.picture_width, view.picture_height);
    const runtime::LightVector light =
        runtime::project_environment(view.picture_light, asset.cubemap_size, {}, threads);
    const std::vector<formats::Rgb> irradiance =
        runtime::shade_for_picture(asset, light, camera.eye, runtime::kAllTerms, threads);
    const runtime::SpecularLight specular = runtime::prefilter_specular(
        view.picture_light, runtime::roughness_levels(asset), {}, threads);
    runtime::SoftwareOptions options;
    options.threads = threads;
    options.specular = specular.maps.empty() ? nullptr : &specular;
    return runtime::render_software(asset, irradiance, view.picture_light, {}, camera, options);
}

}  // namespace

std::span<const std::string_view> stage_group_names() {
    return kGroupNames;
}

StageGroups group_stages(const BakeResult& bake) {
    StageGroups groups(kGroupNames.size(), 0.0);
    double known = 0;
    std::size_t primitive = 0;
    for (const StageReport& stage : bake.stages) {
        Group group = preparation;
        if (starts_with(stage.name, "rows of ") && primitive < bake.asset.primitives.size()) {
            const auto shading = bake.asset.primitives[primitive++].shading;
            group = shading == formats::Shading::translucent ? medium_rows : direct;
        } else if (starts_with(stage.name, "samples of ")) {
            group = samples;
        } else if (starts_with(stage.name, "light maps of ")) {
            group = light_maps;
        } else if (stage.name == "openness") {
            group = openness;
        } else if (stage.name == "self-check") {
            group = check;
        }
        groups[group] += stage.seconds;
        known += stage.seconds;
    }
    groups[preparation] += std::max(0.0, bake.seconds_total - known);
    return groups;
}

formats::Result<PointRecord> run_point(const formats::Scene& scene, const SweepPoint& point,
                                       const SweepView& view, const ProbeLights& lights,
                                       const Context& context) {
    forget_peak_memory();
    const double cpu_before = cpu_seconds();
    Knobs knobs = point.knobs;
    knobs.check_model = false;  // later: it is no part of what a bake costs
    auto bake = run_bake(scene, knobs, context);
    if (!bake) {
        return std::move(bake).error();
    }
    const double cpu_after = cpu_seconds();
    const formats::AssetView asset = bake->asset.view();
    PointRecord record;
    record.point = point;
    record.seconds = bake->seconds_total;
    record.cpu_seconds = cpu_after - cpu_before;
    record.groups = group_stages(*bake);
    record.stages = bake->stages;
    record.bytes = formats::opal_size(asset);
    record.peak_bytes = bake->stages.empty() ? 0 : bake->stages.back().peak_rss_bytes;
    record.error = bake->error;
    // Knobs are compared: what a mesh is too coarse for is the same for all of them.
    static_cast<MeasuredError&>(record.error) = bake->error.at_receivers;
    record.luminance = relight_probes(asset, view.probes, lights);
    if (point.knobs.check_model) {
        ModelCheckOptions options;
        options.seed = knobs.seed;
        auto checked = check_model(scene, asset, options, context);
        if (!checked) {
            return std::move(checked).error();
        }
        record.model_error = std::move(*checked);
    }
    auto picture = draw(asset, view, context.threads);
    if (!picture) {
        return std::move(picture).error();
    }
    record.picture = std::move(*picture);
    return record;
}

}  // namespace opaline::bake
