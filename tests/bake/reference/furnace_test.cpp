#include <gtest/gtest.h>

#include <cmath>
#include <string>

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

// 1 to 1e-3, with a standard error small enough to say so, and within three stored standard errors,
// over all receivers. Exact where every path carries 1: then the stored variance is rounding.
void expect_white(const bake::Estimate& estimate, const std::string& what) {
    const bake::Moments all = merged(estimate.pixel);
    EXPECT_NEAR(all.mean.y, 1, 1e-3) << what;
    EXPECT_LT(standard_error(all), 3e-4) << what;
    EXPECT_NEAR(all.mean.y, 1, 3 * standard_error(all) + 2e-6) << what;
    EXPECT_EQ(estimate.lost, 0u) << what;
}

std::string describe(float eta, float g) {
    return "eta " + std::to_string(eta) + " g " + std::to_string(g);
}

// White light on a body without absorption: its radiance is 1 everywhere.
TEST(ReferenceFurnace, RefractingBodyThatAbsorbsNothingIsAsBrightAsItsSurroundings) {
    for (const float eta : {1.5f, 0.8f}) {
        for (const float g : {0.0f, 0.7f, -0.4f}) {
            Scene input = make_scene({make_sphere(2)});
            input.materials[0].medium = make_medium(3, 1, g, eta);
            const auto body = make_fixture(std::move(input), make_white_sky());
            expect_white(estimate(*body, 8, 2000), describe(eta, g));
        }
    }
}

// A bowl: of all its light some 8 % leave through the opening.
TEST(ReferenceFurnace, WhatLeavesThroughAHoleIsAsBrightAsTheRest) {
    for (const float eta : {1.5f, 1.0f}) {
        Primitive bowl = make_sphere(2);
        std::vector<std::uint32_t> kept;
        for (std::size_t i = 0; i + 2 < bowl.index.size(); i += 3) {
            if (bowl.position[bowl.index[i]].y > -0.7f) {
                kept.insert(kept.end(), &bowl.index[i], &bowl.index[i] + 3);
            }
        }
        ASSERT_LT(kept.size(), bowl.index.size());
        bowl.index = kept;
        Scene input = make_scene({std::move(bowl)});
        input.materials[0].medium = make_medium(3, 1, 0, eta);
        const auto body = make_fixture(std::move(input), make_white_sky());
        const auto estimate = opaline::tests::estimate(*body, 8, 2000);
        EXPECT_GT(estimate.lost, 8u * 2000 / 50) << eta;
        for (const bake::Moments& m : estimate.pixel) {
            EXPECT_NEAR(m.mean.y, 1, 3 * standard_error(m) + 0.002) << eta;
            EXPECT_LT(standard_error(m), 0.02) << eta;
        }
    }
}

// A cube of side 2, moved.
Primitive cube_at(glm::vec3 centre) {
    Primitive cube = make_cube(1, false);
    for (glm::vec3& p : cube.position) {
        p += centre;
    }
    return cube;
}

// Two cubes that share a face, overlap with four faces in one plane each, or are one and the same
// are the box around both. Their coordinates are no round numbers: points of faces are rounded.
TEST(ReferenceFurnace, BodiesOfOneMediumThatTouchOrOverlapAreOneBody) {
    const glm::vec3 at(0.3f, 17.1f, -3.7f);
    for (const float apart : {2.0f, 1.1f, 0.0f}) {
        Primitive box = make_cube(1, false);
        for (glm::vec3& p : box.position) {
            p = at + glm::vec3(p.x > 0 ? 1 + apart : -1, p.y, p.z);
        }
        for (const float eta : {1.4f, 1.0f}) {
            Scene two = make_scene({cube_at(at), cube_at(at + glm::vec3(apart, 0, 0))});
            Scene one = make_scene({box});
            one.materials[0].medium = two.materials[0].medium = make_medium(2, 0.8f, 0, eta);
            const auto pair = make_fixture(two, make_white_sky());
            const auto whole = make_fixture(one, make_white_sky());
            for (const glm::vec3 direction : {glm::vec3(0, -1, 0), glm::vec3(0.6f, -0.8f, 0)}) {
                const glm::vec3 from = at + glm::vec3(0.4f, 1, 0.2f) - 3.0f * direction;
                const bake::Moments a = look(pair->space(), from, direction, 4000);
                const bake::Moments b = look(whole->space(), from, direction, 4000);
                EXPECT_NEAR(a.mean.x, b.mean.x,
                            4 * std::hypot(standard_error(a), standard_error(b)))
                    << apart << " " << eta;
                EXPECT_LT(standard_error(a), 0.01);
            }
            if (apart == 2) {
                continue;  // vertices of the face between have no outside
            }
            two.materials[0].medium = make_medium(20, 1, 0, eta);
            const auto furnace = make_fixture(std::move(two), make_white_sky());
            const bake::Estimate found = estimate(*furnace, 48, 16);
            EXPECT_LE(found.lost, 8u)
                << "of 768, where rounding meets an edge: " << apart << " " << eta;
            for (const bake::Moments& m : found.pixel) {
                EXPECT_TRUE(m.mean.x == 0 || std::abs(m.mean.x - 1) < 0.3) << m.mean.x;
            }
        }
    }
}

TEST(ReferenceFurnace, HoldsForEachChannelOfAColouredMedium) {
    formats::Medium medium = make_medium(1, 1, 0.5f, 1.3f);
    medium.sigma_s = {0.3f, 2, 9};
    Scene input = make_scene({make_sphere(2)});
    input.materials[0].medium = medium;
    const auto body = make_fixture(std::move(input), make_white_sky());
    const bake::Moments all = merged(estimate(*body, 8, 20000).pixel);
    // All channels of a path share one flight, so their sum never changes.
    EXPECT_NEAR((all.mean.x + all.mean.y + all.mean.z) / 3, 1, 1e-3);
    const glm::dvec3 error = glm::sqrt(all.variance_of_mean());
    for (const int c : {0, 1, 2}) {
        EXPECT_NEAR(all.mean[c], 1, 3 * error[c]) << c;
        EXPECT_LT(error[c], 0.01);
    }
}

TEST(ReferenceFurnace, WhiteSurfacesThatFaceEachOtherVanish) {
    // Two plates: half of the light comes by way of the other one.
    const auto plates = make_fixture(make_scene({make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}),
                                                 make_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2})}),
                                     make_white_sky());
    const bake::Estimate found = estimate(*plates, 8, 320000);
    for (const bake::Moments& m : found.pixel) {
        EXPECT_NEAR(m.mean.x, 1, 3 * standard_error(m));
    }
    expect_white(found, "plates");
}

// Two wide sheets close together, each reflecting r and transmitting t: what passes and returns
// between them adds up to r + t^2 / (1 - r) under light from both sides.
TEST(ReferenceFurnace, TwoSheetsExchangeLightAsTheSeriesSays) {
    constexpr float kReflect = 0.3f, kTransmit = 0.5f;
    Scene input = make_scene({make_quad({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}),
                              make_quad({-50, 0.05f, -50}, {0, 0, 100}, {100, 0, 0})});
    input.materials[0].sheet =
        formats::Sheet{{kReflect, kReflect, kReflect}, {kTransmit, kTransmit, kTransmit}};
    input.materials[0].double_sided = true;
    const auto sheets = make_fixture(std::move(input), make_white_sky());
    bake::Moments seen = look(sheets->space(), {0, 2, 0}, {0, -1, 0}, 100000);
    seen.merge(look(sheets->space(), {0, -2, 0}, {0, 1, 0}, 100000));
    const double expected = kReflect + kTransmit * kTransmit / (1 - kReflect);
    EXPECT_NEAR(seen.mean.x, expected, 4 * standard_error(seen) + 1e-3);
    EXPECT_LT(standard_error(seen), 2e-3);
}

// Light that goes into a core and out again through its coat is the coat's: none is left for
// `interreflection`.
TEST(ReferenceFurnace, LightOfACoreInACoatCountsAsTheCoats) {
    Scene input = make_scene({make_sphere(2), make_sphere(2, 0.7f)});
    input.materials.push_back(input.materials[0]);
    input.materials[0].medium = make_medium(2, 1, 0, 1.3f);
    input.materials[1].medium = make_medium(6, 1, 0.5f, 1.5f);
    input.primitives[1].material = 1;
    const auto body = make_fixture(std::move(input), make_white_sky());
    auto chosen = bake::choose_receivers(body->scene, 1000000, 3, kAlongNormals);
    chosen.resize(8);
    const auto mean_of = [&](formats::TermSet terms) {
        bake::PathOptions paths;
        paths.terms = terms;
        return mean_over(body->space(paths), chosen, 4000);
    };
    using formats::TermSet;
    EXPECT_EQ(mean_of(TermSet::interreflection).mean.y, 0);
    const bake::Moments own =
        mean_of(TermSet::single | TermSet::multiple | TermSet::unscattered | TermSet::specular);
    EXPECT_NEAR(own.mean.y, 1, 4 * standard_error(own) + 1e-3);
    EXPECT_LT(standard_error(own), 0.005);
    EXPECT_GT(mean_of(TermSet::unscattered).mean.y, 0.001);
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
    direct.terms = formats::TermSet::diffuse;
    across.terms = formats::TermSet::interreflection;
    EXPECT_EQ(mean_over(body->space(direct), chosen, 200).mean.x, 0);
    bake::EstimateOptions options;
    options.samples = 200;
    expect_white(bake::estimate_receivers(body->space(across), chosen, options, {}).value(),
                 "plate in a ball");
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
