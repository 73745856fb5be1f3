#pragma once

#include <cstdint>

#include "bake/effects/layers/bake_layers.h"
#include "bake/effects/layers/layer_knobs.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A scene that is one even layer of small droplets over a grey ground.
inline formats::Scene layer_scene(float thickness = 100, double effective_radius = 3e-6) {
    formats::CloudLayer layer;
    layer.name = "layer 1";
    layer.columns = layer.rows = 2;
    layer.thickness.assign(4, thickness);
    layer.effective_radius = effective_radius;
    layer.ground_albedo = {{128, 128, 128, 255}};
    formats::Scene scene;
    scene.materials.resize(1);
    scene.layers.push_back(layer);
    return scene;
}

inline Knobs layer_knobs_of(Quality quality) {
    Knobs knobs;
    knobs.quality = quality;
    return knobs;
}

/// Tables as small as may be, of few droplets: what does not depend on them is quick.
inline Knobs least_layer_knobs() {
    Knobs knobs = layer_knobs_of(Quality::draft);
    knobs.set(kCloudStep, 2);
    knobs.set(kCloudNodes, 8);
    return knobs;
}

/// A bake of the scene's first layer, with everything on.
inline BakedLayers bake_layer(const formats::Scene& scene, const Knobs& knobs,
                              unsigned threads = 0) {
    const LayerLayout layout;
    Context context;
    context.threads = threads;
    StageLog log;
    auto baked = bake_layers({scene, {&layout, 1}, knobs}, context, log);
    return std::move(baked).value();
}

}  // namespace opaline::bake
