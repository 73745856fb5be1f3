#include <gtest/gtest.h>

#include "bake/physics/scattering_color.h"
#include "formats/image/srgb.h"
#include "tests/bake/varied/varied_body.h"

namespace opaline::tests {
namespace {

const bake::WalkStart kTop = start_below({0, 0.995f, 0}, {0, 1, 0});

TEST(WalkInVariedMedium, AWhiteFieldKeepsTheBitsOfTheHomogeneousMedium) {
    const formats::Medium medium = make_forward_medium(5, 0.9f, 0.3f, 1.3f);
    Scene scene = make_mapped_ball(medium);
    variation_of(scene).color = add_inner_texture(scene, make_even_image(255));
    variation_of(scene).marble = formats::Marble{0.2f, {{1, 1, 1}, {1, 1, 1}}};
    const auto varied = make_walked_scene(std::move(scene));
    const auto plain = make_walked_body(make_sphere(3), medium);
    ASSERT_TRUE(varied->space.media.front().field);
    ASSERT_FALSE(plain->space.media.front().field);
    const Leaving a = walk_from(varied->space, kTop, 1, 2000);
    const Leaving b = walk_from(plain->space, kTop, 1, 2000);
    EXPECT_EQ(a.all, b.all);
    EXPECT_EQ(a.counts.events, b.counts.events);
}

TEST(WalkInVariedMedium, AFieldOfOneColorIsTheMediumOfThatScatteringColor) {
    Scene scene = make_mapped_ball(make_forward_medium(5, 0.9f, 0, 1.3f));
    variation_of(scene).color = add_inner_texture(scene, make_even_image(190));
    const double share = static_cast<double>(formats::linear_from_srgb(190 / 255.0f));
    const double albedo = bake::albedo_of_color(share * bake::scattering_color(0.9, 0), 0);
    const auto varied = make_walked_scene(std::move(scene));
    const auto plain = make_walked_body(
        make_sphere(3), make_forward_medium(5, static_cast<float>(albedo), 0, 1.3f));
    const Leaving a = walk_from(varied->space, kTop, 1, 20000);
    const Leaving b = walk_from(plain->space, kTop, 1, 20000);
    EXPECT_LT(b.all, 0.5);
    EXPECT_NEAR(a.all, b.all, 1e-3 * b.all);
}

// Where nothing is absorbed, what does not leave scattered left unscattered: e to the minus of the
// optical depth, which the density's integral says.
TEST(WalkInVariedMedium, LightPassesARodUnscatteredAsTheIntegralOfItsDensitySays) {
    for (const float sigma_t : {0.5f, 3.0f}) {
        const auto rod = make_walked_scene(make_rod(make_forward_medium(sigma_t, 1, 0, 1)));
        bake::WalkStart start = start_below({-1, 0.013f, 0.008f}, {-1, 0, 0});
        start.seen = start.normal;
        const Leaving leaving = walk_from(rod->space, start, 1, 60000);
        EXPECT_NEAR(1 - leaving.all, std::exp(-sigma_t), 4 * leaving.error + 0.002) << sigma_t;
        EXPECT_LT(leaving.error, 0.003);
        EXPECT_EQ(leaving.counts.lost + leaving.counts.endless, 0u);
    }
}

TEST(WalkInVariedMedium, FurnaceOfAlbedoOneLosesNothingWhateverTheDensity) {
    for (const float eta : {1.0f, 1.5f}) {
        Scene scene = make_mapped_ball(make_forward_medium(300, 1, 0, eta));
        // From a tenth to all of it: nothing leaves unscattered.
        variation_of(scene).density = add_inner_texture(scene, {2, 1, {25, 0, 0, 0, 255, 0, 0, 0}});
        const auto ball = make_walked_scene(std::move(scene));
        for (const glm::vec3 at : {glm::vec3(0.995f, 0, 0), {0, 0.995f, 0}, {-0.995f, 0, 0}}) {
            const Leaving leaving =
                walk_from(ball->space, start_below(at, glm::normalize(at)), 1, 1000);
            EXPECT_NEAR(leaving.all, 1, 4 * leaving.error + 0.002) << eta << ' ' << at.x;
        }
    }
}

}  // namespace
}  // namespace opaline::tests
