#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include "bake/physics/scattering_color.h"
#include "bake/scene/inspect_scene.h"
#include "bake/scene/marble.h"
#include "bake/scene/medium_field.h"
#include "formats/image/srgb.h"
#include "tests/support/media.h"
#include "tests/support/varied_media.h"

namespace opaline::bake {
namespace {

// A ball whose texture rises along x.
formats::Scene make_ball(formats::Medium medium) {
    formats::Primitive ball = tests::make_sphere(4);
    tests::map_along_x(ball);
    medium.variation.emplace();
    return tests::make_translucent_scene({ball}, medium);
}

formats::Variation& variation_of(formats::Scene& scene) {
    return *scene.materials[0].medium->variation;
}

TEST(MediumField, BelowAPointOfTheSurfaceTheColorIsThatOfTheTextureThere) {
    formats::Scene scene = make_ball(tests::make_grey_medium(9, 1));
    variation_of(scene).color = tests::add_inner_texture(scene, tests::make_rising_image());
    const MediumField field(scene, 0);
    const formats::Primitive& ball = scene.primitives[0];
    for (std::size_t v = 0; v < ball.position.size(); v += 37) {
        // Half a cell of the grid; the image is as wide as the ball.
        const float u = std::clamp(ball.texcoord[v].x, 0.02f, 0.98f);
        const float color = formats::linear_from_srgb((256 * u - 0.5f) / 255);
        EXPECT_NEAR(field.color(0.999f * ball.position[v]).x, color, 0.02f) << v;
    }
}

TEST(MediumField, InsideTheColorIsThatOfTheNearestPointOfTheSurface) {
    formats::Scene scene = make_ball(tests::make_grey_medium(9, 1));
    variation_of(scene).strength = tests::add_inner_texture(scene, tests::make_rising_image());
    const MediumField field(scene, 0);
    for (const glm::vec3 at : {glm::vec3(0.3f, 0.4f, 0), {-0.2f, 0, 0.5f}, {0.5f, -0.5f, 0.1f}}) {
        // Straight out; alpha is linear.
        EXPECT_NEAR(field.color(at).y, 0.5f + 0.5f * glm::normalize(at).x, 0.01f);
    }
}

TEST(MediumField, VeinsAreThoseOfTheWorldPosition) {
    formats::Scene scene = make_ball(tests::make_grey_medium(9, 1));
    scene.origin = {100, -20, 3};
    variation_of(scene).marble = formats::Marble{0.3f, {{1, 0, 0.5f}, {0.2f, 1, 0.5f}}};
    const MediumField field(scene, 0);
    for (const glm::vec3 at : {glm::vec3(0), {0.3f, 0.2f, -0.6f}, {-0.9f, 0, 0}}) {
        const formats::Rgb veins = marble_color(*variation_of(scene).marble, scene.to_world(at));
        EXPECT_EQ(field.color(at), glm::vec3(veins.r, veins.g, veins.b));
    }
}

TEST(MediumField, TheLocalScatteringColorIsTheStatedOneTimesTheFields) {
    formats::Medium medium = tests::make_grey_medium(9, 1);
    medium.sigma_s.b = 0;
    formats::Scene scene = make_ball(medium);
    variation_of(scene).g = 0.6f;
    variation_of(scene).color = tests::add_inner_texture(scene, tests::make_even_image(150));
    const MediumField field(scene, 0);
    const double color = static_cast<double>(formats::linear_from_srgb(150 / 255.0f));
    EXPECT_NEAR(static_cast<double>(field.albedo({0, 0, 0}).x),
                albedo_of_color(color * scattering_color(0.9, 0.6), 0.6), 1e-4);
    EXPECT_EQ(field.albedo({0, 0, 0}).z, 0);
}

TEST(MediumField, DensityIsTheRedChannelAndNeverZero) {
    formats::Scene scene = make_ball(tests::make_grey_medium(9, 1));
    variation_of(scene).density =
        tests::add_inner_texture(scene, {2, 1, {0, 255, 255, 255, 102, 0, 0, 0}});
    const MediumField field(scene, 0);
    EXPECT_TRUE(field.has_density());
    EXPECT_NEAR(field.density({-0.9f, 0, 0}), 1.0f / 255, 1e-4f);
    EXPECT_NEAR(field.density({0.9f, 0, 0}), 0.4f, 1e-4f);
    EXPECT_EQ(field.color({0, 0, 0}), glm::vec3(1));
}

// Squares a tenth of a node's distance wide: their mean, of each texture by itself. Points had one
// or the other.
TEST(MediumField, TexturesFinerThanItsNodesAreTheirMean) {
    constexpr std::uint32_t kSide = 1024;
    formats::Image8 checker{kSide, kSide, {}};
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        const std::uint8_t code = (i % kSide + i / kSide) % 2 == 0 ? 255 : 0;
        checker.rgba.insert(checker.rgba.end(), 4, code);
    }
    formats::Scene scene = make_ball(tests::make_grey_medium(9, 1));
    formats::Primitive& body = scene.primitives[0];
    body.texcoord.clear();
    for (const glm::vec3& p : body.position) {
        body.texcoord.emplace_back(0.5f * p.x, 0.5f * p.y);
    }
    variation_of(scene).color = tests::add_inner_texture(scene, checker);
    variation_of(scene).density = tests::add_inner_texture(scene, checker);
    scene.materials[0].medium->variation->color.wrap_u = formats::TextureWrap::repeat;
    const MediumField field(scene, 0);
    for (int i = 0; i < 50; ++i) {
        const glm::vec3 at(0.7f * std::sin(static_cast<float>(i)), 0.3f, 0.01f * (i % 7) + 0.5f);
        EXPECT_NEAR(field.color(at).y, 0.5, 0.05);
        EXPECT_NEAR(field.density(at), 0.5, 0.05);
    }
}

TEST(MediumField, BodiesWithoutAVolumeOrCoordinatesHaveOne) {
    formats::Scene scene = make_ball(tests::make_grey_medium(9, 1));
    variation_of(scene).color = tests::add_inner_texture(scene, tests::make_even_image(0));
    for (glm::vec3& p : scene.primitives[0].position) {
        p.y = p.z = 0;
    }
    EXPECT_LT(MediumField(scene, 0).color({0, 0, 0}).x, 1e-4f);
    scene.primitives[0].texcoord.clear();
    EXPECT_EQ(MediumField(scene, 0).color({0, 0, 0}), glm::vec3(1));
    scene.primitives[0].position.assign(scene.primitives[0].position.size(), glm::vec3(3));
    EXPECT_EQ(MediumField(scene, 0).color({0, 0, 0}), glm::vec3(1));
    scene.primitives.clear();
    EXPECT_EQ(MediumField(scene, 0).density({0, 0, 0}), 1);
}

TEST(MediumField, GreyMediaWithColoredVeinsOrTexelsAreNotGrey) {
    formats::Scene scene = make_ball(tests::make_grey_medium(9, 1));
    EXPECT_TRUE(inspect_scene(scene).material[0].varies);
    EXPECT_TRUE(inspect_scene(scene).material[0].is_grey);
    variation_of(scene).color = tests::add_inner_texture(scene, tests::make_rising_image());
    EXPECT_TRUE(inspect_scene(scene).material[0].is_grey);
    scene.inner_images[0].rgba[401] ^= 1;
    EXPECT_FALSE(inspect_scene(scene).material[0].is_grey);
    scene.inner_images[0].rgba[401] ^= 1;
    variation_of(scene).marble = formats::Marble{0.3f, {{1, 1, 1}, {0.2f, 0.2f, 0.2f}}};
    EXPECT_TRUE(inspect_scene(scene).material[0].is_grey);
    variation_of(scene).marble->colors[1].b = 0.3f;
    EXPECT_FALSE(inspect_scene(scene).material[0].is_grey);
}

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
