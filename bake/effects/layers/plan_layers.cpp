#include "bake/effects/layers/plan_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "bake/effects/layers/layer_tables.h"
#include "bake/physics/slab/solve_slab.h"
#include "bake/plan/plan_input.h"
#include "formats/image/srgb.h"

namespace opaline::bake {
namespace {

constexpr unsigned kPlanRadii = 96;
constexpr int kPlanStreams = 24;
/// Of so few radii and streams: what is lost of the extinction, and of light scattered often.
constexpr double kMargin = 1.05, kOftenMargin = 1.25;
constexpr std::size_t kDecisions = 3;  // on a layer

double largest_albedo(const formats::CloudLayer& layer) {
    double most = 0;
    for (const auto& color : layer.ground_albedo) {
        for (std::size_t band = 0; band < 3; ++band) {
            most = std::max(most,
                            static_cast<double>(formats::linear_from_srgb(color[band] / 255.0f)));
        }
    }
    return most;
}

double scattered_share(double depth) {
    return -std::expm1(-depth / kBoundCosine);
}

// 1 - T_0 - T_1 - R_1 of a beam at the bound's cosine: by reciprocity that is the radiance of light
// scattered twice or more, of both sides, that a view at this cosine sees under even light.
double scattered_often(const DropletBand& band, double thickness) {
    SlabRequest request;
    request.optical_depth =
        std::min(kMaxSlabDepth, rest_extinction(band.split, band.kappa) * thickness);
    request.cosine = {kBoundCosine};
    request.streams = kPlanStreams;
    request.orders = 2;
    const SlabSolution slab = solve_slab(rest_medium(band.split, kPlanStreams), request).front();
    double once_or_never = 0;
    for (const SlabFluxes& order : slab.order) {
        once_or_never += order.transmittance[0] + order.reflectance[0];
    }
    return std::clamp(kOftenMargin * (1 - once_or_never), 0.0, 1.0);
}

}  // namespace

LayerBounds bound_layer(const formats::CloudLayer& layer) {
    LayerBounds bounds;
    const double thickness =
        static_cast<double>(*std::ranges::max_element(layer.thickness, std::less<>{}));
    if (!(thickness > 0) || !(layer.droplets > 0)) return bounds;
    const auto bands = scatter_bands(layer, {1, kPlanRadii, kPlanRadii}, {});
    if (!bands) {
        constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
        return {kUnknown, kUnknown, kUnknown};
    }
    for (const DropletBand& band : *bands) {
        bounds.cloud = std::max(bounds.cloud, scattered_share(kMargin * band.kappa * thickness));
        // As printed, two scatterings grow like the depth: no bound is less than all light.
        bounds.often =
            layer.paper ? bounds.cloud : std::max(bounds.often, scattered_often(band, thickness));
    }
    bounds.radiosity = largest_albedo(layer) * bounds.cloud;
    return bounds;
}

LayerPlan plan_layers(const formats::Scene& scene, const Knobs& knobs) {
    LayerPlan plan;
    for (std::uint32_t i = 0; i < scene.layers.size(); ++i) {
        const formats::CloudLayer& layer = scene.layers[i];
        const Subject subject{Subject::Kind::layer, i, layer.name};
        const LayerBounds bounds = bound_layer(layer);
        PlanEntry cloud = decide_by_bound(kCloud, subject, bounds.cloud, kDecisions, knobs);
        PlanEntry often = decide_by_bound(kCloudOften, subject, bounds.often, kDecisions, knobs);
        PlanEntry ground =
            decide_by_bound(kRadiosity, subject, bounds.radiosity, kDecisions, knobs);
        const char* const unseen = "the layer is so thin that it is not seen";
        explain(cloud,
                layer.paper
                    ? "droplets scatter light: fidelity paper, tables of the forms that "
                      "[Bouthors2006] prints"
                    : "droplets scatter light: tables of a plane layer by its optical depth",
                bounds.cloud > 0 ? unseen : "the layer has no thickness or no droplets");
        if (!cloud.on) {
            often.on = often.forced = ground.on = ground.forced = false;
        }
        explain(often, "light is scattered more than once: a table of radiance",
                cloud.on ? "so thin that light is scattered once at most" : unseen);
        explain(ground, "ground and base of the layer light each other",
                !cloud.on              ? unseen
                : bounds.radiosity > 0 ? "ground and layer return hardly any light to each other"
                                       : "the ground is black");
        plan.layouts.push_back({i, cloud.on, often.on, ground.on});
        for (PlanEntry* const entry : {&cloud, &often, &ground}) {
            tell_forced(*entry);
            plan.entries.push_back(std::move(*entry));
        }
    }
    return plan;
}

}  // namespace opaline::bake
