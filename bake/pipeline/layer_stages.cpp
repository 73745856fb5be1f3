#include "bake/pipeline/layer_stages.h"

#include <string>
#include <utility>

#include "bake/base/interrupted.h"
#include "bake/check/error_warnings.h"
#include "bake/effects/layers/plan_layers.h"
#include "bake/physics/mie/droplets.h"

namespace opaline::bake {
namespace {

void state_error(const LayerErrorReport& found, ErrorReport& error) {
    error.by_effect.push_back({std::string(kCloud), found.rms_relative});
    if (error.receivers_checked > 0) return;
    error.rms_relative = found.rms_relative;
    error.ci95[0] = found.ci95[0];
    error.ci95[1] = found.ci95[1];
    error.max_relative = found.worst;
    error.reference = found.reference;
}

void warn_of_layer(const formats::CloudLayer& layer, const Knobs& knobs,
                   const LayerErrorReport& error, std::vector<formats::Diagnostic>& warnings) {
    const bool asked = knobs.error_target > 0;
    const double limit = asked ? knobs.error_target : acceptable_error(knobs.quality);
    if ((asked ? error.rms_relative : error.ci95[0]) > limit) {
        const std::string found = layer.name + " errs by " + error_percent(error.rms_relative);
        const std::string allowed =
            error_percent(limit) + (asked ? " asked for" : " that pass unnoticed");
        warnings.push_back(formats::make_warning(
            "", asked ? "--error" : "self-check",
            layer.paper ? found +
                              " because fidelity \"paper\" takes the formulas that "
                              "[Bouthors2006] prints, more than the " +
                              allowed
                        : found + ", more than the " + allowed,
            layer.paper ? "keep it to reproduce published figures, leave \"fidelity\" out "
                          "otherwise: no option lowers it"
                        : "give a smaller --cloud-step and more --cloud-nodes"));
    }
    const DropletDistribution droplets = droplets_of(layer);
    if (relative_width(droplets) < kMonodisperse) {
        warnings.push_back(formats::make_warning(
            "", layer.name,
            "its droplets are so alike (gamma " + number_text(droplets.gamma) +
                ") that its phase function has the ripples of single spheres",
            "give a gamma below " +
                std::to_string(static_cast<int>(1 / (kMonodisperse * kMonodisperse) - 4))));
    }
}

}  // namespace

formats::Status add_layers(const formats::Scene& scene, std::span<const LayerLayout> layouts,
                           const Context& context, BakeResult& result) {
    auto baked = bake_layers({scene, layouts, result.knobs}, context, result.stages);
    if (!baked) return std::move(baked).error();
    result.asset.clouds = std::move(baked->clouds);
    const formats::CloudsView clouds = result.asset.clouds.view();
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        if (!layouts[i].cloud) continue;
        result.layer_error =
            run_stage(result.stages, "self-check of clouds", "self-check", [&](std::uint64_t&) {
                return check_layer(clouds, clouds.records[i], baked->droplets[i], result.knobs.seed,
                                   context);
            });
        if (context.cancelled()) return interrupted();
        state_error(*result.layer_error, result.error);
        warn_of_layer(scene.layers[layouts[i].layer], result.knobs, *result.layer_error,
                      result.warnings);
    }
    return formats::ok_status();
}

}  // namespace opaline::bake
