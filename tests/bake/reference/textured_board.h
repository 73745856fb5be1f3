#pragma once

#include <cmath>
#include <limits>

#include "bake/reference/path_filter.h"
#include "tests/support/scenes.h"

namespace opaline::tests {

/// Side x side texels in squares of 1 and 0.
inline formats::Image8 checker_image(std::uint32_t side) {
    formats::Image8 image{side, side, {}};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const std::uint8_t value = (i % side + i / side) % 2 == 0 ? 255 : 0;
        image.rgba.insert(image.rgba.end(), {value, value, value, 255});
    }
    return image;
}

/// A board at a height, facing up, its texture once over every 2 m.
inline Scene textured_board(float height, float side = 2) {
    const float half = side / 2;
    Scene scene = make_scene({make_quad({-half, height, half}, {side, 0, 0}, {0, 0, -side})});
    Primitive& p = scene.primitives[0];
    p.texcoord.clear();
    for (const glm::vec3& at : p.position) {
        p.texcoord.emplace_back(0.5f * (at.x + 1), 0.5f * (at.z + 1));
    }
    scene.images = {checker_image(64)};
    scene.materials[0].base_color_image = 0;
    return scene;
}

/// Steps of so many samples a pixel, without a limit of the gradient.
inline bake::TextureFiltering filtering_of(const Scene& scene, std::uint32_t samples) {
    return {bake::make_scene_pyramids(scene), 1 / std::sqrt(static_cast<float>(samples)),
            std::numeric_limits<float>::infinity(), 100};
}

}  // namespace opaline::tests
