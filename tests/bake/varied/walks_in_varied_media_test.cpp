#include <gtest/gtest.h>

#include <utility>

#include "bake/physics/fresnel.h"
#include "bake/physics/scattering_color.h"
#include "formats/image/srgb.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/bake/walks/body_walks.h"
#include "tests/support/varied_media.h"

namespace opaline::tests {
namespace {

/// A ball of a medium, mapped along x.
inline Scene make_mapped_ball(const formats::Medium& medium, int levels = 3) {
    Primitive ball = make_sphere(levels);
    map_along_x(ball);
    Scene scene = make_translucent_scene({std::move(ball)}, medium);
    scene.materials[0].medium->variation.emplace();
    return scene;
}

inline formats::Variation& variation_of(Scene& scene) {
    return *scene.materials[0].medium->variation;
}

/// A rod from x = -1 to 1, 0.1 wide, whose density rises evenly along x: almost nowhere is its side
/// farther than its end.
inline constexpr float kRodHalfWidth = 0.05f;
inline Scene make_rod(const formats::Medium& medium) {
    Primitive rod = make_cube(1, false);
    map_along_x(rod);
    for (glm::vec3& p : rod.position) {
        p *= glm::vec3(1, kRodHalfWidth, kRodHalfWidth);
    }
    Scene scene = make_translucent_scene({std::move(rod)}, medium);
    scene.materials[0].medium->variation.emplace();
    variation_of(scene).density = add_inner_texture(scene, make_rising_image());
    return scene;
}

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

// Veins of strong contrast and a density that rises from 0.1 to 1, bands with extinctions of their
// own: two codes that share nothing but the field and the triangles.
TEST(WalksBesideReference, SeeTheSameLightOfAVeinedBallOfVaryingDensity) {
    formats::Medium medium = make_forward_medium(4, 0.95f, 0.4f, 1.3f);
    medium.sigma_s = {6, 4, 2};
    Scene scene = make_mapped_ball(medium);
    variation_of(scene).marble =
        formats::Marble{0.5f, {{0.05f, 0.1f, 0.9f}, {0.9f, 0.2f, 0.1f}, {1, 1, 1}}};
    variation_of(scene).density = add_inner_texture(scene, {2, 1, {25, 0, 0, 0, 255, 0, 0, 0}});
    variation_of(scene).g = 0.4f;
    const auto walked = make_walked_scene(scene, false);
    const auto fixture = make_fixture(std::move(scene), make_white_sky());
    const auto passed = bake::fresnel_transmittance(1, 1.3);
    double largest = 0, smallest = 1;
    for (const glm::vec3 axis :
         {glm::vec3(0.6f, 0.8f, 0), {0, 0.6f, 0.8f}, {-0.8f, 0, 0.6f}, {0, -1, 0}}) {
        // Where the line meets a facet.
        const auto hit = fixture->scene.surfaces.closest_hit({3.0f * axis}, -axis, 10);
        ASSERT_TRUE(hit);
        bake::WalkStart start{hit->position - 1e-5f * hit->flat, axis, hit->flat, 1, axis};
        const BandsLeaving leaving =
            walk_bands(walked->space, start, 12000, [](const auto&) { return true; });
        bake::PathOptions terms;
        terms.terms = bake::TermSet::single | bake::TermSet::multiple;
        const bake::PathSpace space = fixture->space(terms);
        bake::ReferenceReceiver receiver;
        receiver.position = hit->position;
        receiver.outside = hit->position + 1e-5f * hit->flat;
        receiver.inside = start.position;
        receiver.normal = receiver.to_eye = axis;
        receiver.medium = 0;
        const bake::Moments seen = merged(trace_in_parts(32000, [&](bake::RandomStream& random) {
            return bake::trace_receiver(space, receiver, random);
        }));
        for (int b = 0; b < 3; ++b) {
            const auto at = static_cast<std::size_t>(b);
            const double walks = passed * leaving.mean[at], error = leaving.error[at];
            EXPECT_NEAR(walks, seen.mean[b],
                        4 * std::hypot(error, std::sqrt(seen.variance_of_mean()[b])))
                << axis.x << ' ' << axis.y << ' ' << axis.z << " band " << b;
            EXPECT_LT(error, 0.02 * walks);
            largest = std::max(largest, walks);
            smallest = std::min(smallest, walks);
        }
    }
    EXPECT_GT(largest, 2 * smallest) << "there is nothing to tell apart";
}

bake::Moments look_along_rod(const formats::Medium& medium, bake::TermSet terms,
                             std::uint32_t samples) {
    const auto rod = make_fixture(make_rod(medium), make_white_sky());
    return look(rod->space({terms}), {-2, 0.013f, 0.008f}, {1, 0, 0}, samples);
}

TEST(ReferenceInVariedMedium, LightPassesARodUnscatteredAsTheIntegralOfItsDensitySays) {
    for (const float sigma_t : {0.5f, 3.0f}) {
        const bake::Moments seen =
            look_along_rod(make_medium(sigma_t, 1, 0, 1), bake::TermSet::unscattered, 60000);
        EXPECT_NEAR(seen.mean.y, std::exp(-sigma_t), 4 * standard_error(seen) + 0.002) << sigma_t;
        EXPECT_LT(standard_error(seen), 0.003);
    }
}

TEST(ReferenceInVariedMedium, FurnaceOfAlbedoOneIsWhiteWhateverTheDensity) {
    for (const float eta : {1.0f, 1.4f}) {
        formats::Medium medium = make_medium(3, 1, 0.3f, eta);
        medium.sigma_s = {1, 3, 9};
        Scene scene = make_mapped_ball(medium);
        variation_of(scene).density = add_inner_texture(scene, make_rising_image());
        const auto ball = make_fixture(std::move(scene), make_white_sky());
        const bake::Moments seen =
            look(ball->space(), {0.3f, 2, 0.2f}, {0, -1, 0}, eta == 1 ? 160000 : 40000);
        for (int band = 0; band < 3; ++band) {
            EXPECT_NEAR(seen.mean[band], 1, 4 * std::sqrt(seen.variance_of_mean()[band]) + 1e-5);
            EXPECT_LT(std::sqrt(seen.variance_of_mean()[band]), 0.007);
        }
    }
}

}  // namespace

}  // namespace opaline::tests
