// Single scattering in isolated convex bodies: nothing occludes the light, but rays must still find
// the far side of the body.
// Bodies of an index of 1 so small that light hardly scatters twice: what it does is less than the
// plan's bound, in truth and by diffusion.
// Media so dense that light leaves where it entered: what a half space sends back, and that samples
// and light maps would find the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/effects/multiple/rule_multiple.h"
#include "bake/reference/reference_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"
#include "tests/support/sheets.h"

namespace opaline::bake {
namespace {

// Midpoint rule.
double integrate(double from, double to, const std::function<double(double)>& f) {
    constexpr int kSteps = 2000;
    const double step = (to - from) / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        sum += f(from + (i + 0.5) * step);
    }
    return step * sum;
}

// Light 1 from everywhere, no absorption, index 1, isotropic: what is scattered once along the
// normal is int_0^tau e^-t T(t) dt, T the mean transmittance from depth t to the boundary.
double sheet_truth(double tau) {
    return integrate(0, tau, [tau](double t) {
        return std::exp(-t) * 0.5 * integrate(0, 1, [tau, t](double cosine) {
                   return std::exp(-t / cosine) + std::exp(-(tau - t) / cosine);
               });
    });
}
double ball_truth(double tau) {
    const double radius = 0.5 * tau;
    return integrate(0, tau, [radius](double t) {
        const double r = radius - t;
        return std::exp(-t) * 0.5 * integrate(-1, 1, [radius, r](double cosine) {
                   const double across = r * r * (1 - cosine * cosine);
                   return std::exp(r * cosine - std::sqrt(radius * radius - across));
               });
    });
}

// On the edge of the sheet half of the directions see the light through no medium at all, and the
// others what the middle of the sheet sees.
double rim_truth(double tau) {
    return 0.5 * (1 - std::exp(-tau)) + 0.5 * sheet_truth(tau);
}

// `tau`: optical thickness, over `thickness` [m].
formats::Medium clear_medium(float tau, float thickness) {
    return tests::make_grey_medium(tau / thickness, 0, 1);
}

BakeOptions single_scattering(bool by_rays) {
    BakeOptions options = tests::only({"single"});
    options.cubemap_size = 16;
    options.set(kDepthSamples, 8);
    options.quality = by_rays ? Quality::reference : Quality::preview;
    return options;
}

double mean_blue(const std::vector<formats::Rgb>& radiance) {
    double sum = 0;
    for (const formats::Rgb c : radiance) {
        sum += static_cast<double>(c.b);
    }
    return sum / static_cast<double>(radiance.size());
}

// Error of the bake's self-check under the white light.
double error_under_white(const BakeResult& baked) {
    const auto& lights = baked.error.at_receivers.by_light;
    const auto white = std::find_if(lights.begin(), lights.end(),
                                    [](const auto& light) { return light.name == "white"; });
    return white != lights.end() ? white->rms_relative : 1;
}

TEST(ThinBodies, ASheetThatStandsAloneScattersOnceWhatTheIntegralSays) {
    EXPECT_NEAR(sheet_truth(0.2), 0.134, 0.001);
    constexpr std::uint32_t kCells = 8, kMiddle = (kCells / 2) * (kCells + 2);
    const auto scene =
        tests::make_translucent_scene(tests::make_sheet(0.01f, kCells), clear_medium(0.2f, 0.01f));
    for (const bool by_rays : {false, true}) {
        const BakeResult baked = tests::bake_scene(scene, single_scattering(by_rays));
        ASSERT_FALSE(find_entry(baked.plan, "light.visibility", 0)->on);
        const auto radiance = tests::relight(baked.asset.view(), "white");
        EXPECT_NEAR(static_cast<double>(radiance[kMiddle].b) / sheet_truth(0.2), 1, 0.02)
            << by_rays;
        // The vertices of this edge lie on the rim without being corners of its triangles.
        for (std::size_t v = 1; v < kCells; ++v) {
            EXPECT_NEAR(static_cast<double>(radiance[v].b) / rim_truth(0.2), 1, 0.02)
                << by_rays << ' ' << v;
        }
        EXPECT_LT(error_under_white(baked), by_rays ? 0.003 : 0.01) << by_rays;
    }
}

TEST(ThinBodies, ABallThatStandsAloneScattersOnceWhatTheIntegralSays) {
    EXPECT_NEAR(ball_truth(0.5), 0.318, 0.002);
    const auto scene =
        tests::make_translucent_scene({tests::make_sphere(4, 0.5f)}, clear_medium(0.5f, 1));
    for (const bool by_rays : {false, true}) {
        BakeOptions options = single_scattering(by_rays);
        options.cubemap_size = 8;  // 16 gives the same to 2e-5 in three times the time
        const BakeResult baked = tests::bake_scene(scene, options);
        ASSERT_FALSE(find_entry(baked.plan, "light.visibility", 0)->on);
        const auto radiance = tests::relight(baked.asset.view(), "white");
        EXPECT_NEAR(mean_blue(radiance) / ball_truth(0.5), 1, 0.02) << by_rays;
        EXPECT_LT(error_under_white(baked), 0.02) << by_rays;
    }
}

PlanEntry multiple_of(const formats::Scene& scene, const Knobs& knobs = {}) {
    return *find_entry(plan_bake(scene, inspect_scene(scene), knobs), "multiple", 0);
}

// Of albedo 0.9; light crosses its diagonal, 2 sqrt(3), over `depth` mean free paths.
formats::Scene smoke_ball(double depth, float g = 0) {
    const auto sigma = static_cast<float>(depth / (2 * std::sqrt(3.0)));
    return tests::make_translucent_scene({tests::make_sphere(3)},
                                         tests::make_medium(sigma, 0.9f, g, 1));
}

formats::Scene smoke_sheet(double depth, float g = 0) {
    const auto sigma = static_cast<float>(depth / std::sqrt(8.01));
    return tests::make_translucent_scene(tests::make_sheet(0.1f),
                                         tests::make_medium(sigma, 0.9f, g, 1));
}

TEST(SmallBodies, SendOutLessThatScatteredTwiceThanTheirBound) {
    PathOptions paths;
    paths.terms = TermSet::multiple;
    EstimateOptions wanted;
    wanted.samples = 4096;
    for (const double depth : {0.05, 0.5, 2.0, 10.0}) {
        for (const float g : {0.0f, 0.6f}) {
            double seen = 0;  // a thin sheet's paths hardly ever scatter twice, a ball's do
            for (const auto& scene : {smoke_ball(depth, g), smoke_sheet(depth, g)}) {
                const auto fixture = tests::make_fixture(scene, tests::make_white_sky());
                const auto receivers = choose_receivers(fixture->scene, 12, 0, std::nullopt);
                const auto truth = estimate_receivers(fixture->space(paths), receivers, wanted, {});
                double largest = 0, error = 0;
                for (const Moments& m : truth->pixel) {
                    largest = std::max(largest, m.mean.x);
                    error = std::max(error, tests::standard_error(m));
                }
                const formats::Medium& medium = *scene.materials[0].medium;
                const MaterialFacts body = inspect_scene(scene).material[0];
                const double bound = small_body_bound(
                    medium, bands_of(medium)[0],
                    static_cast<double>(glm::length(body.high - body.low)), body.area);
                seen = std::max(seen, largest);
                EXPECT_LE(largest, bound + 4 * error) << depth << " g " << g;
                // The plan takes it where it is less than what diffusion makes of a half space.
                EXPECT_LE(multiple_of(scene).bound, bound);
                if (depth < 0.1) {
                    EXPECT_EQ(multiple_of(scene).bound, bound);
                }
            }
            EXPECT_GT(seen, 0) << depth;
        }
    }
}

TEST(SmallBodies, MultipleScatteringLeftOutIsLessThanItsBound) {
    constexpr double kThin = 0.045, kThicker = 0.055;
    BakeOptions options = tests::small_bake();
    const BakeResult chosen = tests::bake_scene(smoke_ball(kThin), options);
    simulate_all_but_bounces(options);
    const BakeResult all = tests::bake_scene(smoke_ball(kThin), options);
    const PlanEntry& left_out = *find_entry(chosen.plan, "multiple", 0);
    ASSERT_FALSE(left_out.on) << left_out.bound;
    EXPECT_TRUE(find_entry(chosen.plan, "single", 0)->on);
    EXPECT_TRUE(find_entry(all.plan, "multiple", 0)->forced);
    const double difference = tests::largest_difference(chosen.asset, all.asset, "white");
    EXPECT_GT(difference, 0) << "nothing was forced";
    EXPECT_LE(difference, left_out.bound);
    EXPECT_TRUE(multiple_of(smoke_ball(kThicker)).on);
}

// Diffusion sums its profile over the surface, of which folds may have any amount in little room:
// there the bound is the profile's centre times the area. Of profiles that are scaled to the energy
// of a walk, which for forward phase functions is more than any dipole's, somewhat more.
TEST(SmallBodies, ManyFoldsSendOutNoMoreThanTheCentreOfTheProfileAllOverThem) {
    constexpr double kDiagonal = 0.1, kArea = 50;
    for (const auto kind : {formats::Medium::Profile::classic, formats::Medium::Profile::better}) {
        for (const float albedo : {0.1f, 0.5f, 0.99f}) {
            for (const float g : {-0.8f, 0.0f, 0.5f, 0.9f}) {
                formats::Medium medium = tests::make_medium(0.01f, albedo, g, 1);
                medium.profile = kind;
                const MediumProfile profile = make_medium_profile(medium);
                const double bound =
                    small_body_bound(medium, bands_of(medium)[0], kDiagonal, kArea);
                const double sum = profile.eval(0, 0) * kArea;
                EXPECT_GE(bound, (1 - 1e-9) * sum) << albedo << " g " << g;
                if (kind == formats::Medium::Profile::classic) {
                    EXPECT_LE(bound, (1 + 1e-9) * sum) << albedo << " g " << g;
                }
            }
        }
    }
}

// Total reflection may keep light in a body for any number of its diameters.
TEST(SmallBodies, ThatReflectInsideAreTakenForHalfSpaces) {
    auto scene = smoke_ball(0.045);
    EXPECT_LT(multiple_of(scene).bound, 0.002);
    scene.materials[0].medium->eta = 1.3f;
    EXPECT_GT(multiple_of(scene).bound, 0.5);
}

// Albedo 0.9, 0.8, 0.5; `mean_free_path` [m] of red.
formats::Medium clay(float mean_free_path) {
    const float sigma = 1 / mean_free_path;
    formats::Medium medium;
    medium.sigma_s = {0.9f * sigma, 0.8f * sigma, 0.5f * sigma};
    medium.sigma_a = {0.1f * sigma, 0.2f * sigma, 0.5f * sigma};
    medium.eta = 1.3f;
    return medium;
}

BakeResult bake_spread(const formats::Scene& scene, bool forced) {
    BakeOptions options = tests::only({"multiple", "single"});
    options.coefficients = kAllCoefficients;
    options.simulate_all = forced;
    return tests::bake_scene(scene, options);
}

const PlanEntry& spread_of(const BakeResult& result) {
    return *find_entry(result.plan, "multiple.spread", 0);
}

TEST(Spread, OfADenseSmoothBodyIsLeftOutAndSamplesFindTheSame) {
    const auto scene = tests::make_translucent_scene({tests::make_sphere(5)}, clay(5e-5f));
    const BakeResult local = bake_spread(scene, false), spread = bake_spread(scene, true);
    ASSERT_FALSE(spread_of(local).on) << spread_of(local).bound;
    EXPECT_TRUE(spread_of(spread).forced);
    EXPECT_FALSE(tests::has_stage(local, "samples of "));
    EXPECT_FALSE(tests::has_stage(local, "light maps of "));
    EXPECT_TRUE(tests::has_stage(spread, "samples of "));
    EXPECT_GT(local.error.receivers_checked, 20u);
    EXPECT_LT(local.error.at_receivers.rms_relative, 0.05) << "suns on a cube map of 8";
    const auto b = tests::relight(spread.asset.view(), "white");
    EXPECT_GT(b[0].g, 0.1f);
    // What samples, light maps and codes err by.
    EXPECT_LE(tests::largest_difference(local.asset, spread.asset, "white"),
              spread_of(local).bound + 0.005 * double{b[0].r});
}

TEST(Spread, IsSimulatedAsSoonAsItCouldShow) {
    const auto plan_of = [](const formats::Scene& scene) {
        return *find_entry(plan_bake(scene, inspect_scene(scene), {}), "multiple.spread", 0);
    };
    const auto ball = [](unsigned level, const formats::Medium& medium) {
        return tests::make_translucent_scene({tests::make_sphere(level)}, medium);
    };
    EXPECT_FALSE(plan_of(ball(5, clay(5e-5f))).on);
    EXPECT_TRUE(plan_of(ball(5, clay(1e-3f))).on) << "light goes farther";
    EXPECT_TRUE(plan_of(ball(3, clay(5e-5f))).on) << "facets lean from their normals";
    const auto sheet = tests::make_translucent_scene(
        {tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 4)}, clay(5e-5f));
    EXPECT_TRUE(plan_of(sheet).on) << "an open surface may be thin";
    auto inverted = ball(5, clay(5e-5f));
    formats::Primitive& p = inverted.primitives[0];
    const glm::vec3 &a = p.position[p.index[0]], &b = p.position[p.index[1]],
                    &c = p.position[p.index[2]];
    // As scans have some: against its facet's, and a little too long.
    p.normal[p.index[0]] = -1.000001f * glm::normalize(glm::cross(b - a, c - a));
    EXPECT_TRUE(plan_of(inverted).on) << "a facet seen from behind";
    formats::Medium forward = clay(5e-5f);
    forward.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.6f, 0, {}, {}};
    EXPECT_TRUE(plan_of(ball(5, forward)).on) << "one band absorbs, and light leaves it in a peak";
    forward = tests::make_grey_medium(1.8e5f, 2e4f);
    forward.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.9f, 0, {}, {}};
    EXPECT_TRUE(plan_of(ball(5, forward)).on) << "walks hold light that leaves in a peak";
}

TEST(Spread, LeftOutCountsTowardTheErrorAskedFor) {
    const auto scene = tests::make_translucent_scene({tests::make_sphere(5)}, clay(5e-5f));
    const SceneFacts facts = inspect_scene(scene);
    Knobs knobs;
    EXPECT_FALSE(find_entry(plan_bake(scene, facts, knobs), "multiple.spread", 0)->on);
    knobs.error_target = 0.01;
    EXPECT_TRUE(find_entry(plan_bake(scene, facts, knobs), "multiple.spread", 0)->on);
}

}  // namespace

}  // namespace opaline::bake
