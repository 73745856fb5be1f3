#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "tests/support/scenes.h"

namespace opaline::tests {

/// One texel of one code in all channels.
inline formats::Image8 make_even_image(std::uint8_t code) {
    return {1, 1, {code, code, code, code}};
}

/// 256 texels in a row: codes rise from 0 to 255 in red, green, blue and alpha.
inline formats::Image8 make_rising_image() {
    formats::Image8 image{256, 1, {}};
    for (int code = 0; code < 256; ++code) {
        image.rgba.insert(image.rgba.end(), 4, static_cast<std::uint8_t>(code));
    }
    return image;
}

/// Coordinates (u, 1/2) with u from 0 to 1 along x, over the body's whole length.
inline void map_along_x(Primitive& body) {
    const auto [low, high] = std::ranges::minmax(body.position, {}, &glm::vec3::x);
    body.texcoord.clear();
    for (const glm::vec3 p : body.position) {
        body.texcoord.emplace_back((p.x - low.x) / (high.x - low.x), 0.5f);
    }
}

/// Adds an image to the scene that does not go on outside of [0, 1].
inline formats::InnerTexture add_inner_texture(Scene& scene, formats::Image8 image) {
    scene.inner_images.push_back(std::move(image));
    return {static_cast<std::uint32_t>(scene.inner_images.size() - 1), formats::TextureWrap::clamp,
            formats::TextureWrap::clamp};
}

}  // namespace opaline::tests
