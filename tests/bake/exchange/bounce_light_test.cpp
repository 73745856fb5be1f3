#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bake/check/check_model.h"
#include "bake/effects/interreflection/interreflection.h"
#include "bake/exchange/bounce_ends.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/series_end.h"
#include "bake/scene/lobe_record.h"
#include "tests/bake/exchange/bounce_support.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

const std::vector<std::string> kWith{"direct", "interreflection"};

BakeOptions with_rays(double rays) {
    BakeOptions options = tests::bounce_options(kWith);
    options.set(kBounceRays, rays);
    return options;
}

// White surfaces under white light, all paths of which end in the sky: radiance 1 everywhere, even
// in the crack between ball and floor, after any number of bounces.
TEST(BounceLight, WhiteFurnaceOfABallOverAFloor) {
    const BakeResult baked = tests::bake_scene(tests::make_dented_ball(), with_rays(256));
    double squares = 0, mean = 0;
    const auto radiance = tests::relight(baked.asset.view(), "white");
    for (const formats::Rgb& c : radiance) {
        const double error = static_cast<double>(c.g) - 1;
        squares += error * error / static_cast<double>(radiance.size());
        mean += error / static_cast<double>(radiance.size());
        EXPECT_NEAR(error, 0, 0.1);
    }
    EXPECT_LT(std::sqrt(squares), 0.016);
    EXPECT_LT(std::abs(mean), 0.004);
}

// A ball over its floor against path tracing, all orders of reflection. The bound on the RMS is
// that of few receivers, some of them deep in dents, and the reference's noise.
TEST(BounceLight, AgreesWithPathTracing) {
    formats::Scene ball = tests::make_dented_ball();
    ball.materials[0].base_color = {0.7f, 0.7f, 0.7f};
    const BakeResult baked = tests::bake_scene(ball, with_rays(144));
    ModelCheckOptions wanted;
    wanted.simulated = held_light(all_effects(), baked.plan);
    wanted.receivers = 48;
    wanted.noise = 0.03;
    wanted.noise_share = 1;
    const auto report = check_model(ball, baked.asset.view(), wanted, {}).value();
    for (const ModelErrorReport::Part& light : report.by_light) {
        if (light.name == "white" || light.name == "studio") {
            EXPECT_LT(light.rms_relative, 0.06) << light.name;
            EXPECT_LT(std::abs(light.bias), 0.02) << light.name;
            EXPECT_LT(light.missing, 1e-3) << "nothing is left out";
        }
    }
}

// A red floor lights the lower half of a white ball, and the ball's file has three bands.
TEST(BounceLight, ColourBleeds) {
    formats::Scene scene = tests::make_dented_ball();
    scene.materials.push_back({.name = "Floor", .base_color = {0.8f, 0.1f, 0.1f}});
    scene.primitives[1].material = 1;
    const BakeResult baked = tests::bake_scene(scene, with_rays(64));
    EXPECT_EQ(baked.asset.primitives[0].bands, 3u);
    const auto radiance = tests::relight(baked.asset.view(), "sky:3,60");
    const auto plain = tests::relight(
        tests::bake_scene(scene, tests::bounce_options({"direct"})).asset.view(), "sky:3,60");
    double red = 0, blue = 0;
    for (std::size_t v = 0; v < scene.primitives[0].position.size(); ++v) {
        if (scene.primitives[0].normal[v].y < -0.5f) {
            red += radiance[v].r - plain[v].r;
            blue += radiance[v].b - plain[v].b;
        }
    }
    EXPECT_GT(red, 4 * blue);
    EXPECT_GT(blue, 0);
}

// Shares of a point's irradiance that surfaces cover, one for each of many seeds.
struct Shares {
    double mean = 0, deviation = 0, rays = 0;
};

Shares cover(const formats::Scene& scene, const Receiver& at, const BounceGrid& grid,
             std::uint64_t seeds) {
    const RayScene rays = RayScene::build(scene, 1).value();
    double sum = 0, squares = 0, traced = 0;
    std::vector<BounceEnd> ends;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        traced += static_cast<double>(find_bounce_ends(scene, rays, at, grid, seed, ends));
        double share = 0;
        for (const BounceEnd& end : ends) {
            share += end.is_met ? (end.is_quarter ? 0.25 : 1) / grid.count() : 0;
        }
        sum += share;
        squares += share * share;
    }
    const auto n = static_cast<double>(seeds);
    return {sum / n, std::sqrt(squares / n - sum * sum / (n * n)), traced / n};
}

const Receiver kMiddle{{0.5f, 1e-5f, 0.5f}, {0, 1, 0}};

// The unit square at distance 1 above its middle: 4 / (2 pi) 2 X / sqrt(1 + X^2)
// atan(X / sqrt(1 + X^2)), X = 1/2.
TEST(BounceEnds, CellsCutAtEdgesKnowShapesBetterThanAsManyRaysInCellsOfOneSize) {
    const formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    const double root = std::sqrt(1.25);
    const double expected = 4 / std::numbers::pi * 0.5 / root * std::atan(0.5 / root);
    constexpr std::uint64_t kSeeds = 1024;
    const Shares cut = cover(scene, kMiddle, make_cut_grid(400), kSeeds);
    const Shares even = cover(scene, kMiddle, make_bounce_grid(400), kSeeds);
    EXPECT_LE(cut.rays, 400);
    EXPECT_LT(cut.deviation, 0.9 * even.deviation);
    EXPECT_NEAR(cut.mean, expected, 4 * cut.deviation / 32);
}

// A strip that is thinner than a cell by far: rays that meet it are few, and cells of these are not
// cut for it.
TEST(BounceEnds, ThinThingsCoverWhatTheyCover) {
    const formats::Scene scene =
        tests::make_scene({tests::make_quad({0.6f, 1, 0}, {0.02f, 0, 0}, {0, 0, 1}, 1)});
    constexpr std::uint64_t kSeeds = 4096;
    const Shares truth = cover(scene, kMiddle, make_bounce_grid(65536), 4);
    const Shares cut = cover(scene, kMiddle, make_cut_grid(400), kSeeds);
    EXPECT_NEAR(cut.mean, truth.mean, 4 * cut.deviation / 64);
    EXPECT_GT(truth.mean, 20 * cut.deviation / 64);
}

// A floor, seen from a wall: one edge, and most cells are left whole.
TEST(BounceEnds, WhereNeighboursSeeOnePlaneNothingIsCut) {
    const formats::Scene scene =
        tests::make_scene({tests::make_quad({-1e4f, 1, -1e4f}, {2e4f, 0, 0}, {0, 0, 2e4f}, 1)});
    const RayScene rays = RayScene::build(scene, 1).value();
    const BounceGrid grid = make_cut_grid(400);
    std::vector<BounceEnd> ends;
    EXPECT_EQ(find_bounce_ends(scene, rays, kMiddle, grid, 1, ends), 256u);
    EXPECT_TRUE(std::ranges::none_of(ends, &BounceEnd::is_quarter));
    EXPECT_TRUE(std::ranges::all_of(ends, &BounceEnd::sends));
    const std::uint64_t traced =
        find_bounce_ends(scene, rays, {{0, 0.5f, 0}, {1, 0, 0}}, grid, 1, ends);
    EXPECT_GT(traced, 256u);
    EXPECT_LE(traced, 400u);
    // Every quarter of a cell that was cut has one ray.
    std::vector<std::uint32_t> quarters;
    for (const BounceEnd& end : ends) {
        if (end.is_quarter) {
            quarters.push_back(end.cell);
        }
    }
    std::ranges::sort(quarters);
    EXPECT_TRUE(std::ranges::adjacent_find(quarters) == quarters.end());
}

TEST(SeriesEnd, OfAGeometricSeriesIsKnownAfterTwoOfItsTerms) {
    for (const double q : {0.0, 0.3, 0.98}) {
        SeriesEnd series;
        EXPECT_EQ(series.remaining(), 0) << "without light there is none to come";
        std::array<double, 1> sum{2};
        series.add(sum);
        EXPECT_EQ(series.remaining(), 1) << "nothing is known yet";
        sum[0] += 2 * q;
        series.add(sum);
        EXPECT_NEAR(series.ratio(0), q, 1e-12);
        // The next bounce is 2 q^2, and all light 2 / (1 - q).
        EXPECT_NEAR(2 * q * q * (1 + series.rest(0)), 2 * q * q / (1 - q), 1e-9);
        EXPECT_NEAR(series.remaining(), q * q * q, 1e-12);
    }
}

TEST(SeriesEnd, OfBandsIsThatOfTheBrightest) {
    SeriesEnd series;
    series.add(std::array<double, 3>{1, 1, 0});
    series.add(std::array<double, 3>{1.5, 1.9, 0});
    EXPECT_NEAR(series.remaining(), 0.9 * 0.9 * 0.9, 1e-12);
    EXPECT_NEAR(series.rest(0), 1, 1e-12);
    EXPECT_EQ(series.rest(2), 0);
}

TEST(SeriesEnd, OfLightThatNeverFadesIsFinite) {
    SeriesEnd series;
    series.add(std::array<double, 1>{1});
    series.add(std::array<double, 1>{2});
    EXPECT_EQ(series.ratio(0), SeriesEnd::kLargestRatio);
    EXPECT_GT(series.remaining(), 0.9);
}

// A hollow ball with a hole of the share f of its surface, which sees of the inside what every
// other point of it sees: under a sky of radiance 1 its inside has
//   a f / (1 - a (1 - f)),
// the integrating sphere. With albedo 1 that is the sky itself, however small the hole.
TEST(BounceLight, OfAHollowBallWithAHoleIsThatOfTheIntegratingSphere) {
    tests::Primitive ball = tests::turned_inside_out(tests::make_sphere(3));
    tests::Primitive open = ball;
    open.index.clear();
    double hole = 0, all = 0;
    for (std::size_t i = 0; i < ball.index.size(); i += 3) {
        std::array<glm::vec3, 3> p{};
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = ball.position[ball.index[i + k]];
        }
        const auto area =
            static_cast<double>(0.5f * glm::length(glm::cross(p[1] - p[0], p[2] - p[0])));
        all += area;
        if (p[0].y + p[1].y + p[2].y > 3 * 0.9f) {
            hole += area;
        } else {
            for (std::size_t k = 0; k < 3; ++k) {
                open.index.push_back(ball.index[i + k]);
            }
        }
    }
    const double f = hole / all;
    EXPECT_NEAR(f, 0.05, 0.01);
    for (const double albedo : {0.9, 1.0}) {
        formats::Scene scene = tests::make_scene({open});
        const auto a = static_cast<float>(albedo);
        scene.materials[0].base_color = {a, a, a};
        BakeOptions options = tests::bounce_options({"direct", "interreflection"});
        options.set(kBounceRays, 16);
        const BakeResult baked = tests::bake_scene(scene, options);
        double mean = 0, count = 0;
        const auto radiance = tests::relight(baked.asset.view(), "white");
        for (std::size_t v = 0; v < radiance.size(); ++v) {
            if (open.position[v].y < 0.8f) {
                mean += static_cast<double>(radiance[v].g);
                ++count;
            }
        }
        const double expected = albedo * f / (1 - albedo * (1 - f));
        EXPECT_NEAR(mean / count / expected, 1, 0.01) << albedo;
    }
}

// Of radiance around a value that is the same everywhere, relative to it.
struct Deviation {
    double mean = 0, rms = 0;
};

Deviation deviation_from(double expected, const std::vector<formats::Rgb>& radiance) {
    Deviation d;
    for (const formats::Rgb& c : radiance) {
        const double error = static_cast<double>(c.g) / expected - 1;
        d.mean += error / static_cast<double>(radiance.size());
        d.rms += error * error / static_cast<double>(radiance.size());
    }
    d.rms = std::sqrt(d.rms);
    return d;
}

BakeOptions furnace_options(std::vector<std::string> effects) {
    BakeOptions options = tests::bounce_options(std::move(effects));
    options.cubemap_size = 8;
    options.set(kBounceRays, 64);
    return options;
}

// A closed box of thin walls, r of the light reflected, t let through, under a sky of radiance 1.
// Inside every ray meets a wall: L_in = r L_in + t; outside L = r + t L_in. Which of both sides is
// the front must not matter. Of even light a glossy lobe mirrors m and leaves d to what is below
// it: what is mirrored inside stays inside, and does not come through from outside.
TEST(BounceFurnace, RadianceOfAClosedBoxOfThinWallsIsEvenInsideAndOutside) {
    constexpr double kReflected = 0.5, kTransmitted = 0.3;
    for (const bool glossy : {false, true}) {
        for (const bool inward : {true, false}) {
            formats::Scene box = tests::make_scene({tests::make_cube(3, inward)});
            box.materials[0].base_color = {1, 1, 1};
            box.materials[0].sheet =
                formats::Sheet{.reflect = {0.5f, 0.5f, 0.5f}, .transmit = {0.3f, 0.3f, 0.3f}};
            double m = 0, d = 1, seen = 1;
            std::vector<std::string> effects{"sheet", "interreflection"};
            if (glossy) {
                effects.insert(effects.begin() + 1, "gloss");
                box.materials[0].gloss.roughness = 0.3f;
                box.materials[0].gloss.specular = 1;
                box.materials[0].gloss.ior = 2;
                const formats::GlossSurface surface = formats::make_gloss_surface(
                    make_lobe_record(box.materials[0].gloss), {1, 1, 1}, 0, 0.3f);
                const MeanReflectance mean = mean_reflectance(surface);
                m = double{mean.mirrored.g};
                d = double{mean.diffuse};
                seen = double{formats::eval_gloss_albedo(surface, 1).diffuse};
                EXPECT_GT(m, 0.12);
            }
            const double inside = d * kTransmitted / (1 - m - d * kReflected);
            const double expected = seen * (inward ? kReflected * inside + kTransmitted
                                                   : kReflected + kTransmitted * inside);
            const BakeResult baked = tests::bake_scene(box, furnace_options(effects));
            const Deviation off =
                deviation_from(expected, tests::relight(baked.asset.view(), "white"));
            EXPECT_LT(off.rms, glossy ? 0.012 : 0.01) << inward;
            EXPECT_LT(std::abs(off.mean), glossy ? 0.008 : 0.005) << inward;
        }
    }
}

// L_in = r L_in + t with r = .99, t = .01: every bounce has .99 of the one before. What 64 of them
// leave is half of the light.
TEST(BounceFurnace, ABoxThatKeepsItsLightShowsTheSkyAndSaysWhatIsExtrapolated) {
    for (const float reflect : {0.99f, 0.5f}) {
        formats::Scene box = tests::make_scene({tests::make_cube(3, true)});
        box.materials[0].base_color = {1, 1, 1};
        const float transmit = 1 - reflect;
        box.materials[0].sheet = formats::Sheet{.reflect = {reflect, reflect, reflect},
                                                .transmit = {transmit, transmit, transmit}};
        const BakeResult baked =
            tests::bake_scene(box, furnace_options({"sheet", "interreflection"}));
        const Deviation off = deviation_from(1, tests::relight(baked.asset.view(), "white"));
        EXPECT_LT(std::abs(off.mean), 0.02) << reflect;
        EXPECT_EQ(std::ranges::count_if(baked.warnings,
                                        [](const formats::Diagnostic& warning) {
                                            return warning.fault.find("extrapolated") !=
                                                   std::string::npos;
                                        }),
                  reflect > 0.9f ? 1 : 0);
    }
}

}  // namespace

}  // namespace opaline::bake
