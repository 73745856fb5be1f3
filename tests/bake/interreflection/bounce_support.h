#pragma once

#include <span>
#include <string>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/transport/ray_scene.h"
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

}  // namespace opaline::tests
