#pragma once

#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "bake/effects/interreflection/interreflection.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/lights/test_lights.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/bake/exchange/bounce_support.h"

namespace opaline::tests {

/// Squares of two sRGB codes, one a texel.
inline formats::Image8 make_checker(std::uint32_t side, std::uint8_t low = 0,
                                    std::uint8_t high = 255) {
    formats::Image8 image{side, side, {}};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const std::uint8_t value = (i % side + i / side) % 2 == 0 ? low : high;
        image.rgba.insert(image.rgba.end(), {value, value, value, 255});
    }
    return image;
}

/// Two unit squares that face each other, half a metre apart, of albedo 0.8; the lower one has the
/// image, `repeats` times along each edge.
inline formats::Scene make_textured_plates(formats::Image8 image, float repeats) {
    formats::Scene scene = make_plates(0.5f, 0.8f, 4);
    scene.images.push_back(std::move(image));
    scene.materials[0].base_color_image = 0;
    scene.primitives[0].texcoord.clear();
    for (const glm::vec3& p : scene.primitives[0].position) {
        scene.primitives[0].texcoord.push_back(repeats * glm::vec2(p.x, p.z));
    }
    return scene;
}

inline formats::Image8 make_even_texels(std::uint32_t side, std::uint8_t code) {
    return make_checker(side, code, code);
}

/// Bounced light between the surfaces of a scene.
struct BouncedIn : LitScene {
    using LitScene::LitScene;

    /// Irradiance of every vertex under an even sky of radiance 1, without what comes straight,
    /// over pi.
    std::vector<double> light(bool filtered) const {
        const bake::ScenePyramids textures = bake::make_scene_pyramids(scene);
        const std::vector<bake::RowLayout> rows = layouts();
        const bake::BakeInputs known = inputs(filtered ? &textures : nullptr);
        const bake::Knobs knobs = bake::resolve_knobs(bounce_options({"direct"})).value();
        std::uint64_t traced = 0;
        const bake::LightInputs asked{
            known, knobs, {}, rows, {}, bake::count_bounce_rays(knobs[bake::kBounceRays])};
        const auto bounced =
            bake::solve_exchange(asked, bake::place_exchange(asked, traced), {}, traced);
        std::vector<float> even;  // a sky of radiance 1
        for (int face = 0; face < 6; ++face) {
            for (const double solid_angle : formats::texel_solid_angles(8)) {
                even.push_back(static_cast<float>(solid_angle));
            }
        }
        formats::haar_forward_cube(std::span<float>(even), 8);
        std::vector<double> light;
        for (const bake::Receiver& receiver : receivers) {
            std::vector<float> row(6 * 8 * 8);
            bake::add_bounced(*bounced, {receiver}, 8, row);
            light.push_back(bake::relit(row, even) / std::numbers::pi);
        }
        return light;
    }
};

}  // namespace opaline::tests
