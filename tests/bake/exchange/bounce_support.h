#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bake/effects/effects.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "bake/trace/ray_scene.h"
#include "tests/support/bake.h"

namespace opaline::tests {

/// Two unit squares at y = 0 and y = distance that face each other, each its own material.
inline formats::Scene make_plates(float distance, float albedo, std::uint32_t cells) {
    formats::Scene scene = make_scene({make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, cells),
                                       make_quad({0, distance, 0}, {1, 0, 0}, {0, 0, 1}, cells)});
    scene.materials.push_back({.name = "Upper"});
    scene.primitives[1].material = 1;
    for (formats::Material& m : scene.materials) {
        m.base_color = {albedo, albedo, albedo};
    }
    return scene;
}

inline bake::BakeOptions bounce_options(std::vector<std::string> effects) {
    bake::BakeOptions options;
    options.cubemap_size = 8;
    options.coefficients = bake::kAllCoefficients;
    options.threads = 2;
    options.effects = std::move(effects);
    return options;
}

/// A scene and what effects are told of it; textures filtered or null.
struct LitScene {
    explicit LitScene(formats::Scene made) : scene(std::move(made)) {}

    bake::BakeInputs inputs(const bake::ScenePyramids* textures = nullptr) const {
        return {bake::all_effects(), scene, facts, rays, sky, sets, nullptr, textures};
    }
    /// Layouts of rows that are the same for every view.
    std::vector<bake::RowLayout> layouts() const {
        bake::RowLayout layout;
        layout.constant = true;
        return std::vector<bake::RowLayout>(scene.materials.size(), layout);
    }

    formats::Scene scene;
    bake::RayScene rays = bake::RayScene::build(scene, 1).value(),
                   sky = bake::RayScene::build({}, 1).value();
    bake::SceneFacts facts = bake::inspect_scene(scene);
    std::vector<bake::Receiver> receivers = bake::make_vertex_receivers(scene);
    std::vector<bake::ReceiverSet> sets =
        bake::make_vertex_sets(scene, receivers, bake::make_body_points(scene, receivers));
};

}  // namespace opaline::tests
