#include <gtest/gtest.h>

#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

using formats::Material;

/// A white floor under a plate with this alpha mode.
Scene floor_and_plate(Material::AlphaMode mode, float alpha) {
    Scene scene = make_scene({make_quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}),
                              make_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2})});
    Material& plate = scene.materials.emplace_back();
    plate.base_color = {0, 0, 0};
    plate.double_sided = true;
    plate.alpha_mode = mode;
    plate.alpha = alpha;
    scene.primitives[1].material = 1;
    return scene;
}

TEST(ReferenceHoles, BlendTransmitsWhatItDoesNotCover) {
    Scene scene = floor_and_plate(Material::AlphaMode::blend, 0.3f);
    // Always the same line to the light: only the key tells its paths apart.
    scene.lights.push_back(unit_sun({0, -1, 0}));
    const auto fixture = make_fixture(std::move(scene), {});
    const bake::Moments below = look(fixture->space(), {0.2f, 0.5f, 0.1f}, {0, -1, 0}, 20000);
    EXPECT_NEAR(below.mean.x, 0.7, 3 * standard_error(below));
    // From above, the eye's ray passes the plate as well; beneath it the light passed once more.
    const bake::Moments above = look(fixture->space(), {0.2f, 2, 0.1f}, {0, -1, 0}, 20000);
    EXPECT_NEAR(above.mean.x, 0.7 * 0.7, 3 * standard_error(above));
}

TEST(ReferenceHoles, AMaskIsThereOrNot) {
    for (const float alpha : {0.4f, 0.6f}) {
        Scene scene = floor_and_plate(Material::AlphaMode::mask, alpha);
        scene.lights.push_back(unit_sun({0, -1, 0}));
        const auto fixture = make_fixture(std::move(scene), {});
        EXPECT_NEAR(look(fixture->space(), {0.2f, 2, 0.1f}, {0, -1, 0}, 4).mean.x,
                    alpha < 0.5f ? 1 : 0, 1e-5);
    }
}

}  // namespace
}  // namespace opaline::tests
