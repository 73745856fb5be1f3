// Paths through clear bodies with a rough boundary.
#include <gtest/gtest.h>

#include "bake/reference/ggx.h"
#include "bake/reference/rough_boundary.h"
#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

formats::Medium rough_glass(float roughness, float sigma_a = 1e-12f, float eta = 1.5f) {
    formats::Medium glass = make_medium(sigma_a, 0, 0, eta);
    glass.roughness = roughness;
    return glass;
}

// The sky sends 1, a black plate right under the boundary as much per squared index: what is seen
// is the share of light that facets return, reflected and refracted. Sky and plate are met and
// sampled.
TEST(RoughGlass, AFurnaceOnBothSidesShowsWhatFacetsReturn) {
    for (const float roughness : {0.2f, 0.5f, 1.0f}) {
        Scene input = make_slab(rough_glass(roughness), 0.5f);
        input.primitives.push_back(make_quad({-100, 0, 100}, {200, 0, 0}, {0, 0, -200}));
        input.primitives[1].material = 1;
        formats::Material& plate = input.materials.emplace_back();
        plate.base_color = {0, 0, 0};
        plate.emission = {2.25f, 2.25f, 2.25f};
        const auto scene = make_fixture(std::move(input), make_white_sky());
        for (const float cosine : {0.95f, 0.4f}) {
            const glm::vec3 to_eye(0.8f * std::sqrt(1 - cosine * cosine), cosine,
                                   0.6f * std::sqrt(1 - cosine * cosine));
            const auto boundary = bake::make_rough_boundary(
                {0, 1, 0}, to_eye, static_cast<float>(bake::ggx_alpha(double{roughness})), 1.5f);
            double kept = 0;
            constexpr std::uint32_t kSamples = 40000;
            for (std::uint32_t i = 0; i < kSamples; ++i) {
                bake::RandomStream random(3, 1, i);
                const float u = random.next(), v = random.next();
                const auto s = sample_rough_boundary(boundary, u, v, random.next());
                kept += s ? static_cast<double>(s->weight) / kSamples : 0;
            }
            const bake::Moments seen =
                look(scene->space(), glm::vec3(0.7f, 0.125f, 0.3f) + 2.0f * to_eye, -to_eye, 80000);
            EXPECT_NEAR(seen.mean.y, kept, 4 * standard_error(seen) + 2e-3)
                << roughness << ' ' << cosine;
            EXPECT_LT(standard_error(seen), 4e-3);
        }
    }
}

constexpr float kRoughness = 0.5f, kIrradiance = 3;
const glm::vec3 kToSun = glm::normalize(glm::vec3(0.4f, 0.8f, 0.1f));

// A slab under a sun: a disc of the sky, or a light without a surface.
std::unique_ptr<ReferenceFixture> slab_under_sun(bool is_disc) {
    Scene input = make_slab(rough_glass(kRoughness), 0.5f);
    formats::Environment sky;
    if (is_disc) {
        const float radius = 0.01f;
        const float radiance = kIrradiance / static_cast<float>(formats::disc_solid_angle(radius));
        sky.discs.push_back(
            {{kToSun.x, kToSun.y, kToSun.z}, radius, {radiance, radiance, radiance}});
    } else {
        formats::Light& sun = input.lights.emplace_back();
        sun.type = formats::Light::Type::directional;
        sun.direction = {-kToSun.x, -kToSun.y, -kToSun.z};
        sun.intensity = {kIrradiance, kIrradiance, kIrradiance};
    }
    return make_fixture(std::move(input), std::move(sky));
}

// An eye inside, looking up and out: a sun that no path would find is sampled through the boundary.
// What else reaches the eye was reflected inside first. An eye outside sees it mirrored.
TEST(RoughGlass, ASunShinesThroughTheBoundaryAndIsMirroredAsFacetsSay) {
    bake::PathOptions once;
    once.max_depth = 1;
    const auto alpha = static_cast<float>(bake::ggx_alpha(double{kRoughness}));
    bake::SurroundingMedia inside;
    inside.enter(0);
    for (const bool is_inside : {true, false}) {
        const glm::vec3 to_eye =
            -glm::normalize(is_inside ? glm::vec3(0.2f, 1, 0.1f) : glm::vec3(0.3f, -1, 0));
        const auto boundary = bake::make_rough_boundary({0, is_inside ? -1 : 1, 0}, to_eye, alpha,
                                                        is_inside ? 1 / 1.5f : 1.5f);
        const double expected =
            static_cast<double>(kIrradiance * eval_rough_boundary(boundary, kToSun).response);
        ASSERT_GT(expected, is_inside ? 0.1 : 0);
        const glm::vec3 from =
            is_inside ? glm::vec3(0.7f, 0, 0.3f) : glm::vec3(0.7f, 0.125f, 0.3f) + 2.0f * to_eye;
        for (const bool is_disc : {true, false}) {
            const auto scene = slab_under_sun(is_disc);
            const bake::Moments seen = look(scene->space(once), from, -to_eye, 40000,
                                            is_inside ? inside : bake::SurroundingMedia{});
            EXPECT_NEAR(seen.mean.x, expected, 4 * standard_error(seen) + 3e-3 * expected)
                << is_inside << is_disc;
        }
    }
}

bake::Moments seen_from(const ReferenceFixture& fixture, bake::PathOptions options,
                        std::uint32_t samples) {
    return mean_over(fixture.space(options),
                     bake::choose_receivers(fixture.scene, 12, 3, glm::vec3(0, 500, 0)), samples);
}

std::unique_ptr<ReferenceFixture> glass_ball(const formats::Medium& glass, bool lit_from_above) {
    Scene input = make_scene({make_sphere(3)});
    input.materials[0].medium = glass;
    return make_fixture(std::move(input), make_half_sky(lit_from_above));
}

// Seen from aside the body is entered along the refracted ray, with and without its own mirror.
TEST(RoughGlass, WithoutItsOwnMirrorAReceiverHasEverythingElse) {
    using formats::TermSet;
    for (const float roughness : {0.0f, 0.5f}) {
        const auto ball = glass_ball(rough_glass(roughness, 1, 1.6f), true);
        bake::PathOptions rest, no_mirror, mirror;
        rest.terms =
            TermSet::single | TermSet::multiple | TermSet::unscattered | TermSet::interreflection;
        no_mirror.own_mirror = false;
        mirror.terms = TermSet::specular;
        const bake::Moments expected = seen_from(*ball, rest, 20000);
        const bake::Moments found = seen_from(*ball, no_mirror, 20000);
        EXPECT_NEAR(found.mean.x, expected.mean.x,
                    4 * std::hypot(standard_error(found), standard_error(expected)))
            << roughness;
        const bake::Moments whole = seen_from(*ball, {}, 20000),
                            mirrored = seen_from(*ball, mirror, 20000);
        EXPECT_GT(mirrored.mean.x, 0.003);
        EXPECT_NEAR(whole.mean.x, expected.mean.x + mirrored.mean.x,
                    4 * std::hypot(standard_error(whole), standard_error(expected)) + 1e-3)
            << roughness;
    }
}

TEST(RoughGlass, ABodyThatScattersKeepsASmoothBoundary) {
    formats::Medium milk = make_medium(2, 0.5f, 0, 1.5f);
    milk.roughness = 0;
    const bake::Moments smooth = seen_from(*glass_ball(milk, false), {}, 64);
    milk.roughness = 0.9f;
    EXPECT_EQ(seen_from(*glass_ball(milk, false), {}, 64).mean, smooth.mean);
}

}  // namespace
}  // namespace opaline::tests
