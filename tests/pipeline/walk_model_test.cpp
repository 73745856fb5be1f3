// Multiple scattering by random walks in whole bakes: against path tracing, where the dipole fails.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/check/check_model.h"
#include "bake/reference/reference_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "bake/scene/orient_bodies.h"
#include "tests/support/doubled_slab.h"
#include "tests/support/effects.h"
#include "tests/support/sheets.h"
#include "tests/support/walk_bake.h"

namespace opaline::bake {
namespace {

// Under white: the reference converges fast.
auto model_errors(const tests::Scene& scene, const BakeOptions& options,
                  TermSet simulated = TermSet::multiple) {
    ModelCheckOptions check;
    check.simulated = simulated;
    check.receivers = 24;
    check.max_events = 1500000;
    const BakeResult baked = tests::bake_scene(scene, options);
    const auto report = check_model(scene, baked.asset.view(), check, {});
    EXPECT_TRUE(report);
    return report.value().by_light.front();
}

double model_error(const tests::Scene& scene, const BakeOptions& options) {
    return model_errors(scene, options).rms_relative;
}

// In the denser ball sites stand far apart: rows are the dipole's and what they lack.
TEST(WalkModel, BallsAreAsBrightAsPathTracedAlsoWhereTheDipoleIsNot) {
    const auto ball = [](float sigma_t) {
        return tests::make_translucent_scene(
            {tests::make_sphere(3)}, tests::make_grey_medium(0.99f * sigma_t, 0.01f * sigma_t));
    };
    EXPECT_GT(model_error(ball(3), bake_by(kDipole)), 0.15);
    EXPECT_LT(model_error(ball(3), bake_by(kWalked, 100000)), 0.04);
    BakeOptions few_sites = bake_by(kWalked, 50000);
    few_sites.set(kSites, 500);
    EXPECT_LT(model_error(ball(40), few_sites), 0.04);
}

TEST(WalkModel, SelfCheckFindsTheNoiseOfFewWalksAndNoneOfMany) {
    const tests::Scene ball = tests::make_translucent_scene({tests::make_sphere(3)},
                                                            tests::make_grey_medium(2.97f, 0.03f));
    BakeOptions few = bake_by(kWalked, 3000), many = bake_by(kWalked, 200000);
    few.cubemap_size = many.cubemap_size = 16;
    const double noisy = tests::bake_scene(ball, few).error.at_receivers.rms_relative;
    const double clean = tests::bake_scene(ball, many).error.at_receivers.rms_relative;
    EXPECT_GT(noisy, 0.08);
    EXPECT_LT(clean, 0.06);
}

// Light that scatters once is not looked for along the normal there: straight down from an edge
// lies the other face.
TEST(WalkModel, EdgesOfAWhiteCubeOf40MeanFreePathsShowTheEvenSky) {
    const tests::Scene cube = tests::make_translucent_scene({tests::make_cube(4, false)},
                                                            tests::make_grey_medium(20, 0, 1));
    BakeOptions options = bake_by(kWalked, 30000);
    options.effects = {"multiple", "single"};
    options.cubemap_size = 8;
    options.set(kSites, 500);
    const BakeResult baked = tests::bake_scene(cube, options);
    EXPECT_FALSE(entry_of(baked, "single").on);
    const std::vector<formats::Rgb> radiance = tests::relight(baked.asset.view(), "white");
    const std::vector<glm::vec3>& position = cube.primitives.front().position;
    double sum = 0;
    int count = 0;
    for (std::size_t v = 0; v < position.size(); ++v) {
        const glm::bvec3 is_end = glm::greaterThan(glm::abs(position[v]), glm::vec3(0.999f));
        if (int{is_end.x} + int{is_end.y} + int{is_end.z} < 2) continue;
        sum += static_cast<double>(radiance[v].g);
        ++count;
    }
    ASSERT_EQ(count, 6 * 16);
    EXPECT_NEAR(sum / count, 1, 0.13);  // .90; .81 along normals
}

// Of index 1 and isotropic, light scattered once is exact by its own effect.
TEST(WalkModel, LightScatteredOnceIsTheSameByWalksAsByItsOwnEffect) {
    const tests::Scene ball =
        tests::make_translucent_scene({tests::make_sphere(3)}, tests::make_grey_medium(2, 1, 1));
    const auto relit = [&](std::vector<std::string> effects) {
        BakeOptions options = bake_by(kWalked);
        options.effects = std::move(effects);
        options.set(kViewTerms, 4);
        const BakeResult baked = tests::bake_scene(ball, options);
        EXPECT_EQ(entry_of(baked, "single").on,
                  options.effects == std::vector<std::string>{"single"});
        double sum = 0;
        for (const formats::Rgb& c : tests::relight(baked.asset.view(), "white")) {
            sum += static_cast<double>(c.g);
        }
        return sum;
    };
    const double both = relit({"multiple", "single"}), multiple = relit({"multiple"}),
                 single = relit({"single"});
    EXPECT_GT(single, 0.3 * both);
    // What a function linear in the view misses along the normal: 2.7 %.
    EXPECT_NEAR(both, multiple + single, 0.04 * both);
}

// What 25 terms of the phase function cannot hold.
TEST(WalkModel, StronglyForwardMediumIsAsBrightAsPathTracedByWalksAndNotByTermsOfItsPhase) {
    formats::Medium medium = tests::make_grey_medium(20, 1);
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    medium.phase.g = 0.9f;
    const tests::Scene ball = tests::make_translucent_scene({tests::make_sphere(3)}, medium);
    const auto errors = [&](double model) {
        BakeOptions options = bake_by(model, 150000);
        options.effects = {"multiple", "single"};
        options.set(kViewTerms, 4);
        return model_errors(ball, options, TermSet::multiple | TermSet::single);
    };
    EXPECT_LT(errors(kWalked).rms_relative, 0.07) << "four rows by view: 5.7 %";
    EXPECT_GT(errors(kDipole).rms_relative, 0.3);
}

// A sheet of one mean free path is darker seen along its normal than aslant.
TEST(WalkModel, ThinSheetSeenAlongItsNormalIsAsBrightAsPathTracedWithFourRowsAndNotWithOne) {
    const tests::Scene sheet = tests::make_translucent_scene(tests::make_sheet(0.3f, 6, 6),
                                                             tests::make_grey_medium(3, 0.3f, 1));
    BakeOptions one = bake_by(kWalked), four = one;
    one.set(kViewTerms, 1);
    four.set(kViewTerms, 4);
    // The mean over receivers: its noise is small.
    EXPECT_GT(model_errors(sheet, one).bias, 0.15);
    EXPECT_NEAR(model_errors(sheet, four).bias, 0, 0.05);
}

// The file itself, toward eyes aslant: a slab of 6 mean free paths that absorbs half of what
// arrives, against doubling.
TEST(WalkModel, FileOfNineRowsShowsAnAbsorbingSlabTowardEveryEyeBetterThanOneOfFour) {
    const float sigma_t = 6;
    const tests::DoubledSlab doubled(1.0 * static_cast<double>(sigma_t), 0.5, 0, 3);
    const tests::Scene slab = tests::make_translucent_scene(
        tests::make_sheet(1, 8, 4), tests::make_grey_medium(0.5f * sigma_t, 0.5f * sigma_t, 1));
    const auto error = [&](double views) {
        BakeOptions options = bake_by(kWalked, 1000000);
        options.effects = {"multiple", "single"};
        options.set(kViewTerms, views);
        const BakeResult baked = tests::bake_scene(slab, options);
        EXPECT_EQ(baked.asset.view().primitives[0].terms, views);
        const runtime::LightVector white =
            tests::make_light("white", baked.asset.view().cubemap_size);
        double squares = 0, sum = 0;
        for (int i = 0; i < doubled.nodes(); i += 3) {
            const double c = doubled.cosine(i), s = std::sqrt(1 - c * c);
            runtime::ShadeOptions seen;
            seen.eye = {static_cast<float>(1e6 * s), static_cast<float>(1e6 * c), 0};
            std::vector<formats::Rgb> radiance(baked.asset.position.size());
            runtime::shade(baked.asset.view(), white, radiance, seen);
            double mean = 0, count = 0;
            for (std::size_t v = 0; v < baked.asset.primitives[0].vertex_count; ++v) {
                const formats::Vec3 at = baked.asset.position[v];
                if (std::max(std::abs(at.x), std::abs(at.z)) < 1.2f) {  // far from the rim
                    mean += static_cast<double>(radiance[v].g);
                    count += 1;
                }
            }
            const double truth = doubled.reflected_sky(i) + doubled.transmitted_sky(i);
            squares += c * std::pow(mean / count - truth, 2);
            sum += c * truth * truth;
        }
        return std::sqrt(squares / sum);
    };
    EXPECT_GT(error(4), 0.035) << "of the exact fit: .045";
    EXPECT_LT(error(9), 0.025) << "of the exact fit: .012";
}

// A pair of triangles within the ball, one beside it: nothing is between them.
TEST(WalkModel, FlapsWithoutThicknessChangeNoBitOfTheBodyThatTheyStandIn) {
    tests::Primitive flaps;
    for (const float at : {0.3f, 0.7f}) {
        const glm::vec3 corner(at);
        flaps.position.insert(flaps.position.end(), {corner, corner + glm::vec3(0.1f, 0, 0),
                                                     corner + glm::vec3(0, 0.1f, 0)});
    }
    flaps.normal.assign(6, {0, 0, 1});
    flaps.index = {0, 1, 2, 0, 2, 1, 3, 4, 5, 3, 5, 4};
    const formats::Medium medium = tests::make_grey_medium(6, 0.1f);
    const tests::Primitive ball = tests::make_sphere(2);
    const auto relit = [&](std::vector<tests::Primitive> bodies) {
        const BakeResult baked = tests::bake_scene(
            tests::make_translucent_scene(std::move(bodies), medium), bake_by(kWalked, 20000));
        auto colors = tests::relight(baked.asset.view(), "studio");
        EXPECT_TRUE(tests::all_finite(baked.asset));
        colors.resize(ball.position.size());
        return std::pair(colors, baked.error.at_receivers.rms_relative);
    };
    const auto [with, error_with] = relit({ball, flaps});
    const auto [without, error_without] = relit({ball});
    EXPECT_EQ(with, without);
    EXPECT_EQ(error_with, error_without) << "the self-check stands on the ball as well";
    EXPECT_GT(error_without, 0);
    const OrientedBodies bodies =
        orient_bodies(tests::make_translucent_scene({ball, flaps}, medium));
    ASSERT_TRUE(bodies.scene);
    const auto scene = make_reference_scene(*bodies.scene, 1);
    ASSERT_TRUE(scene);
    for (const ReferenceReceiver& r : choose_receivers(*scene, 10000, 0, std::nullopt)) {
        EXPECT_EQ(r.primitive, 0u) << "nothing is compared where there is no triangle";
    }
}

// Mean free paths far below and above the body, no absorption, extreme indices and mean cosines,
// a sheet without volume, slivers, holes, bodies through each other.
TEST(WalkModel, HardCasesGiveFiniteRowsThatAreNoBrighterThanTheSky) {
    tests::Primitive sheet = tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 4);
    tests::Primitive back = tests::make_quad({-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, 4);
    tests::Primitive sliver = tests::make_sphere(1);
    for (glm::vec3& p : sliver.position) {
        p *= glm::vec3(1e-4f, 1, 1e-3f);
    }
    tests::Primitive open = tests::make_sphere(2);
    open.index.resize(open.index.size() / 2);
    const std::vector<std::vector<tests::Primitive>> bodies{
        {tests::make_sphere(2)},
        {sheet, back},
        {sliver},
        {open},
        {tests::make_sphere(2), tests::make_sphere(2, 1, {0.7f, 0, 0})}};
    std::vector<formats::Medium> media{
        tests::make_grey_medium(1e-3f, 0), tests::make_grey_medium(5, 0, 3),
        tests::make_grey_medium(5, 0, 1.0f / 3), tests::make_grey_medium(1e-20f, 1e5f),
        tests::make_grey_medium(30, 0.1f, 1)};
    for (const float g : {-0.99f, 0.99f}) {
        media.push_back(tests::make_grey_medium(20, 0.1f));
        media.back().phase.type = formats::PhaseFunction::Type::henyey_greenstein;
        media.back().phase.g = g;
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        // All media in the ball, two of the hardest in the other bodies, one that light leaves
        // without being reflected in the sliver, where the self-check would take 9 s of others.
        for (std::size_t m = b == 0 ? 0 : b == 2 ? 4 : 1; m < media.size(); m += b == 0 ? 1 : 5) {
            BakeOptions options = bake_by(kWalked, 1000);
            options.set(kSamples, 100);
            options.set(kSites, 500);
            const BakeResult baked =
                tests::bake_scene(tests::make_translucent_scene(bodies[b], media[m]), options);
            EXPECT_TRUE(tests::all_finite(baked.asset)) << b << " " << m;
            for (const formats::Rgb& c : tests::relight_primitive(baked.asset, "white")) {
                EXPECT_TRUE(c.g >= 0 && c.g < 2.5f) << b << " " << m << ": " << c.g;
            }
        }
    }
}

}  // namespace
}  // namespace opaline::bake
