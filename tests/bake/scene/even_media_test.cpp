#include "bake/scene/even_media.h"

#include <gtest/gtest.h>

#include "bake/physics/scattering_color.h"
#include "tests/support/media.h"
#include "tests/support/varied_media.h"

namespace opaline::bake {
namespace {

TEST(EvenMedia, HasTheMeansOfScatteringColorAndDensityOverTheSurface) {
    formats::Primitive ball = tests::make_sphere(4);
    tests::map_along_x(ball);
    formats::Medium medium = tests::make_grey_medium(9, 1);
    medium.variation.emplace();
    formats::Scene scene = tests::make_translucent_scene({ball}, medium);
    formats::Variation& variation = *scene.materials[0].medium->variation;
    // Both rise evenly along x; a ball has as much surface in each slice of its length.
    variation.strength = tests::add_inner_texture(scene, tests::make_rising_image());
    variation.density = {0, formats::TextureWrap::clamp, formats::TextureWrap::clamp};
    const auto evened = even_media(scene);
    ASSERT_TRUE(evened);
    ASSERT_EQ(evened->warnings.size(), 1u);
    const formats::Medium& even = *evened->scene.materials[0].medium;
    EXPECT_FALSE(even.variation);
    const double sigma_t = static_cast<double>(even.sigma_s.g + even.sigma_a.g);
    EXPECT_NEAR(sigma_t, 5, 0.05);
    EXPECT_NEAR(scattering_color(static_cast<double>(even.sigma_s.g) / sigma_t, 0),
                0.5 * scattering_color(0.9, 0), 0.005);
}

TEST(EvenMedia, LeavesHomogeneousScenesAlone) {
    EXPECT_FALSE(even_media(
        tests::make_translucent_scene({tests::make_sphere(1)}, tests::make_grey_medium(9, 1))));
}

}  // namespace
}  // namespace opaline::bake
