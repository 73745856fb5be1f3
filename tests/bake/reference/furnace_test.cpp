#include <gtest/gtest.h>

#include "bake/reference/reference_image.h"
#include "bake/reference/reference_receivers.h"
#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

constexpr std::optional<glm::vec3> kAlongNormals = std::nullopt;

bake::Estimate estimate(const ReferenceFixture& fixture, std::uint32_t receivers,
                        std::uint32_t samples, unsigned threads = 0) {
    const auto chosen = bake::choose_receivers(fixture.scene, receivers, 3, kAlongNormals);
    bake::EstimateOptions options;
    options.samples = samples;
    bake::Context context;
    context.threads = threads;
    return bake::estimate_receivers(fixture.space(), chosen, options, context).value();
}

// White light on a body that absorbs nothing: its radiance is 1 wherever light goes.
TEST(ReferenceFurnace, BodyThatAbsorbsNothingIsAsBrightAsItsSurroundings) {
    for (const float eta : {1.0f, 1.5f, 0.8f}) {
        for (const float g : {0.0f, 0.7f, -0.4f}) {
            Scene input = make_scene({make_sphere(2)});
            input.materials[0].medium = make_medium(3, 1, g, eta);
            const auto body = make_fixture(std::move(input), make_white_sky());
            bake::Moments all;
            for (const bake::Moments& m : estimate(*body, 8, eta == 1 ? 16000 : 100).pixel) {
                all.merge(m);
            }
            // Index-matched media sample the light, whose weights vary; the others need no luck.
            EXPECT_NEAR(all.mean.y, 1, eta == 1 ? 3.5 * standard_error(all) : 1e-3)
                << "eta " << eta << " g " << g;
            EXPECT_LT(standard_error(all), 1.5e-3);
        }
    }
}

TEST(ReferenceFurnace, HoldsForEachChannelOfAColouredMedium) {
    formats::Medium medium = make_medium(1, 1, 0.5f, 1.3f);
    medium.sigma_s = {0.3f, 2, 9};
    Scene input = make_scene({make_sphere(2)});
    input.materials[0].medium = medium;
    const auto body = make_fixture(std::move(input), make_white_sky());
    for (const bake::Moments& m : estimate(*body, 4, 20000).pixel) {
        const glm::dvec3 error = glm::sqrt(m.variance_of_mean());
        for (const int c : {0, 1, 2}) {
            EXPECT_NEAR(m.mean[c], 1, 4 * error[c]) << c;
            EXPECT_LT(error[c], 0.02);
        }
    }
}

TEST(ReferenceFurnace, WhiteSurfacesThatFaceEachOtherVanish) {
    // Two plates: half of the light comes by way of the other one.
    const auto plates = make_fixture(make_scene({make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}),
                                                 make_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2})}),
                                     make_white_sky());
    bake::Moments all;
    for (const bake::Moments& m : estimate(*plates, 8, 320000).pixel) {
        EXPECT_NEAR(m.mean.x, 1, 4 * standard_error(m));
        all.merge(m);
    }
    EXPECT_NEAR(all.mean.x, 1, 1e-3);
    EXPECT_LT(standard_error(all), 2.6e-4);
}

TEST(ReferenceFurnace, ShellsOfOneMediumInEachOtherAreOneBody) {
    // The inner shell changes nothing: same paths, same numbers.
    Scene lone = make_scene({make_sphere(2)}),
          nested = make_scene({make_sphere(2), make_sphere(2, 0.5f)});
    lone.materials[0].medium = nested.materials[0].medium = make_medium(4, 0.8f, 0, 1.4f);
    const auto a = make_fixture(std::move(lone), make_half_sky(true));
    const auto b = make_fixture(std::move(nested), make_half_sky(true));
    const auto chosen = bake::choose_receivers(a->scene, 3, 3, kAlongNormals);
    bake::EstimateOptions options;
    options.samples = 30000;
    const auto outer = bake::estimate_receivers(a->space(), chosen, options, {}).value();
    const auto both = bake::estimate_receivers(b->space(), chosen, options, {}).value();
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        EXPECT_NEAR(outer.pixel[i].mean.x, both.pixel[i].mean.x,
                    4 * std::hypot(standard_error(outer.pixel[i]), standard_error(both.pixel[i])));
    }
    EXPECT_EQ(both.lost, 0u);
}

TEST(ReferenceFurnace, OpaqueVerticesInsideABodySeeTheSkyThroughItOnly) {
    // A white plate in a ball: all its light crosses the boundary; none of it is `diffuse`.
    Scene input =
        make_scene({make_sphere(3), make_quad({-0.3f, 0, -0.3f}, {0, 0, 0.6f}, {0.6f, 0, 0})});
    input.materials.push_back({.name = "White"});
    input.materials[1].double_sided = true;
    input.materials[0].medium = make_medium(2, 1, 0, 1.4f);
    input.primitives[1].material = 1;
    const auto body = make_fixture(std::move(input), make_white_sky());
    auto chosen = bake::choose_receivers(body->scene, 1000000, 0, kAlongNormals);
    chosen.erase(chosen.begin(), chosen.end() - 4);
    bake::PathOptions direct, across;
    direct.terms = bake::term::kDiffuse;
    across.terms = bake::term::kInterreflection;
    bake::EstimateOptions options;
    options.samples = 200;
    const auto none = bake::estimate_receivers(body->space(direct), chosen, options, {}).value();
    const auto all = bake::estimate_receivers(body->space(across), chosen, options, {}).value();
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        EXPECT_EQ(none.pixel[i].mean.x, 0);
        EXPECT_NEAR(all.pixel[i].mean.x, 1, 1e-3);
    }
}

TEST(ReferenceEstimate, SameBitsForAnyNumberOfThreads) {
    Scene input = make_scene({make_sphere(3), make_quad({-3, -1, -3}, {0, 0, 6}, {6, 0, 0}, 4)});
    input.materials.push_back(input.materials[0]);
    input.materials[0].medium = make_medium(5, 0.9f, 0.3f, 1.3f);
    input.primitives[1].material = 1;
    const auto scene = make_fixture(std::move(input), make_half_sky(true));
    const bake::Estimate one = estimate(*scene, 20, 100, 1), three = estimate(*scene, 20, 100, 3);
    for (std::size_t i = 0; i < one.pixel.size(); ++i) {
        EXPECT_EQ(one.pixel[i].mean, three.pixel[i].mean);
        EXPECT_EQ(one.pixel[i].squares, three.pixel[i].squares);
    }
}

}  // namespace
}  // namespace opaline::tests
