#pragma once

#include <string_view>
#include <vector>

#include "bake/effects/layers/bake_layers.h"
#include "bake/plan/bake_plan.h"
#include "bake/plan/knobs.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Effects of cloud layers, as plans, --effects and reports name them.
inline constexpr std::string_view kCloud = "cloud";
inline constexpr std::string_view kCloudOften = "cloud.multiple";
inline constexpr std::string_view kRadiosity = "radiosity";

struct LayerPlan {
    std::vector<PlanEntry> entries;    ///< three a layer, in order; they belong to no rule
    std::vector<LayerLayout> layouts;  ///< of all layers, those without a cloud too
};

/// Decides from thickness, droplets and ground what to bake (README.md, "Bounds"). Droplets are
/// averaged with few radii: some 0.1 s of one thread for 7 um.
LayerPlan plan_layers(const formats::Scene& scene, const Knobs& knobs);

/// Cosine of views that bounds hold for: 6 degrees above or below the horizon, and steeper ones.
inline constexpr double kBoundCosine = 0.1;

/// Upper bounds on radiance under light of radiance 1 from all around, over bands and views.
struct LayerBounds {
    double cloud = 0;      ///< of all light that droplets scatter
    double often = 0;      ///< of light that they scatter twice or more
    double radiosity = 0;  ///< of light that the layer returns to the ground, or passes on from it
};

/// NaN where the droplets are out of range.
LayerBounds bound_layer(const formats::CloudLayer& layer);

}  // namespace opaline::bake
