#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "runtime/volumes/volume_bounds.h"
#include "tests/runtime/volumes/lit_volumes.h"
#include "tests/support/float_traps.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;
using test::kSize;
using test::LitTestVolumes;
using test::TestVolume;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TestVolume full(std::array<float, 12> to_world) {
    TestVolume volume;
    volume.first_brick = {-2, -2, -2};
    volume.extent = {4, 4, 4};
    volume.single_terms = 4;
    volume.moment = {1, 0.5f, 0, 0, 0};
    volume.sigma_t = {0.1f, 3, 1e30f};
    volume.to_world = to_world;
    return volume;
}

void expect_sound(const LitVolumes& lit, const MarchRay& ray) {
    const MarchResult seen = march_volumes(lit, ray);
    for (const Rgb c : {seen.radiance, seen.transmittance}) {
        for (const float x : {c.r, c.g, c.b}) {
            ASSERT_TRUE(std::isfinite(x) && x >= 0);
        }
    }
    ASSERT_LE(seen.transmittance.r, 1);
    const MarchSpan span = volumes_span(lit, ray);
    ASSERT_FALSE(std::isnan(span.begin) || std::isnan(span.end));
}

TEST(HostileRays, GiveFiniteValuesInNoTime) {
    const opaline::tests::UntrappedFloats untrapped;  // what is given overflows
    const LitTestVolumes scene({full({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}),
                                full({1e-30f, 0, 0, 0, 0, 1e-30f, 0, 0, 0, 0, 1e-30f, 0}),
                                full({1e30f, 0, 0, 1e38f, 0, 1, 0, 0, 0, 0, 1e-30f, 3}),
                                full({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
                                full({1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0})});
    const LitVolumes& lit = scene.lit;
    EXPECT_EQ(lit.entry.size(), 3u);  // two have no inverse

    const auto start = std::chrono::steady_clock::now();
    const float values[] = {0, -0.0f, 1, -16, 16, 1e-40f, 1e-30f, -1e20f, 3e38f, -3e38f};
    const float directions[] = {0, -0.0f, 1, -1, 1e-40f, 0.6f};
    std::mt19937 generator(3);
    const auto pick = [&](const auto& from) { return from[generator() % std::size(from)]; };
    const double ends[] = {0, -5, 1e-300, 3, 16, 1e30, 1e300, kInfinity};
    for (int i = 0; i < 20000; ++i) {
        expect_sound(lit, {{pick(values), pick(values), pick(values)},
                           {pick(directions), pick(directions), pick(directions)},
                           pick(ends),
                           pick(ends)});
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 20);
}

TEST(HostileRays, NothingIsMetBetweenAnEndBeforeItsBeginOrWithoutDirection) {
    const LitTestVolumes scene({full({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0})});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const MarchRay& ray :
         {MarchRay{{0, 0, 0}, {1, 0, 0}, 5, 3}, MarchRay{{0, 0, 0}, {1, 0, 0}, 5, 5},
          MarchRay{{0, 0, 0}, {0, 0, 0}}, MarchRay{{0, 0, 0}, {1, 0, 0}, nan},
          MarchRay{{0, 0, 0}, {1, 0, 0}, 0, nan}}) {
        const MarchResult seen = march_volumes(scene.lit, ray);
        EXPECT_EQ(seen.radiance, Rgb{});
        EXPECT_EQ(seen.transmittance, (Rgb{1, 1, 1}));
    }
}

TEST(HostileRays, ABoxSeenAlongItsFacesAndEdges) {
    const LitTestVolumes scene({full({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0})});
    // Along faces between bricks the density is 1 all the same.
    for (const float at : {-8.0f, 0.0f, 8.0f, 0.5f}) {
        const MarchResult seen = march_volumes(scene.lit, {{at, at, -100}, {0, 0, 1}, 0, 115});
        EXPECT_NEAR(seen.transmittance.r, std::exp(-3.1), 1e-5);
    }
    const float d = 1 / std::sqrt(3.0f);
    const MarchResult corner = march_volumes(scene.lit, {{-116, -116, -116}, {d, d, d}});
    EXPECT_LT(corner.transmittance.r, std::exp(-0.1 * 31 * std::sqrt(3.0)));
}

TEST(VolumeBounds, EncloseTheDensityAndNotTheTable) {
    formats::Volumes volumes = test::make_volumes(kSize);
    TestVolume volume = full({2, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0});
    volume.density = [](float x, float y, float z) { return x > 0 && y < 0 && z < -8 ? 1.0f : 0; };
    test::add_volume(volumes, volume);
    const auto corners = volume_corners(volumes.view());
    ASSERT_EQ(corners.size(), 8u);
    EXPECT_EQ(corners.front(), (Vec3{1, -17, -17}));
    EXPECT_EQ(corners.back(), (Vec3{33, 0, -8}));
    EXPECT_TRUE(volume_corners({}).empty());
}

}  // namespace
}  // namespace opaline::runtime
