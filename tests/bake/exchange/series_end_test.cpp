#include "bake/exchange/series_end.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bake/effects/interreflection/interreflection.h"
#include "tests/bake/exchange/bounce_support.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

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

}  // namespace
}  // namespace opaline::bake
