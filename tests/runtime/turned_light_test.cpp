// What a receiver gets with another normal than that of its rows.
#include "runtime/normal_maps/turned_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "tests/runtime/light_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;

constexpr std::uint32_t kTexels = 32;

// Unit directions from +Y at polar angles up to a right angle.
Vec3 tilted(float degrees, float azimuth) {
    const float polar = degrees * std::numbers::pi_v<float> / 180;
    return {std::sin(polar) * std::cos(azimuth), std::cos(polar),
            std::sin(polar) * std::sin(azimuth)};
}

// Sky whose radiance is 1 + 0.9 y, the blue band 1 - 0.5 x.
LightVector gradient() {
    std::vector<Rgb> texels;
    for (std::uint32_t j = 0; j < formats::cubemap_texels(kTexels); ++j) {
        const Vec3 w = formats::texel_direction(kTexels, j / (kTexels * kTexels),
                                                j / kTexels % kTexels, j % kTexels);
        texels.push_back({1 + 0.9f * w.y, 1 + 0.9f * w.y, 1 - 0.5f * w.x});
    }
    return project_cubemap(texels, kTexels);
}

LightVector sun_at(Vec3 direction, float irradiance, float sky) {
    formats::Environment environment;
    environment.layout = formats::Environment::Layout::cube;
    environment.width = 8;
    environment.height = 48;
    environment.pixel.assign(384, {sky, sky, sky});
    const float radius = 0.005f;
    const auto radiance =
        static_cast<float>(static_cast<double>(irradiance) / formats::disc_solid_angle(radius));
    environment.discs.push_back({direction, radius, {radiance, radiance, radiance}});
    return project_environment(environment, kTexels);
}

TEST(TurnedLight, IsThatOfTheOtherNormalUnderASmoothSky) {
    const TurnedLight light = make_turned_light(gradient());
    for (const float degrees : {0.0f, 20.0f, 70.0f}) {
        const Vec3 n = tilted(10, 1), m = tilted(degrees, 4);
        // Irradiance of a linear sky over pi.
        const auto open = [](Vec3 d) { return Rgb{1 + 0.6f * d.y, 1 + 0.6f * d.y, 1 - d.x / 3}; };
        const Rgb turned = turn_light(light, open(n), n, m);
        EXPECT_NEAR(turned.r, open(m).r, 0.01f);
        EXPECT_NEAR(turned.b, open(m).b, 0.01f);
        // What half of the sky is hidden from is taken to lose half of it in all directions.
        const Rgb half = turn_light(light, 0.5f * open(n), n, m);
        EXPECT_NEAR(half.r, 0.5f * turned.r, 1e-5f);
    }
}

TEST(TurnedLight, IsUnchangedUnderEvenLightAndForTheSameNormal) {
    const TurnedLight even = make_turned_light(
        project_cubemap(std::vector<Rgb>(formats::cubemap_texels(8), {2, 1, 0.5f}), 8));
    const TurnedLight sunny = make_turned_light(sun_at(tilted(40, 0), 10, 0.3f));
    for (const float radiance : {-0.1f, 0.0f, 0.2f, 0.9f, 5.0f}) {
        const Rgb of{2 * radiance, radiance, 0.5f * radiance};
        const Rgb turned = turn_light(even, of, tilted(0, 0), tilted(60, 2));
        EXPECT_NEAR(turned.r, of.r, 2e-4f * std::abs(of.r));
        const Rgb same = turn_light(sunny, of, tilted(25, 1), tilted(25, 1));
        EXPECT_NEAR(same.r, of.r, 1e-6f * std::abs(of.r));
    }
}

TEST(TurnedLight, OfASunIsExactOnOpenSurfaces) {
    constexpr float kIrradiance = 5;
    const Vec3 sun = tilted(35, 0.7f);
    const TurnedLight light = make_turned_light(sun_at(sun, kIrradiance, 0));
    const auto open = [&](Vec3 d) {
        const float value = kIrradiance * std::max(dot(d, sun), 0.0f) / std::numbers::pi_v<float>;
        return Rgb{value, value, value};
    };
    const Vec3 n = tilted(0, 0);
    for (const float azimuth : {0.0f, 0.7f, 2.0f, 4.0f}) {
        const Vec3 m = tilted(20, azimuth);
        EXPECT_NEAR(turn_light(light, open(n), n, m).g / open(m).g, 1, 0.01f);
    }
    EXPECT_LT(turn_light(light, open(n), n, tilted(80, 0.7f + std::numbers::pi_v<float>)).g,
              0.02f * open(n).g);
    // No light at all from it behind the surface, whichever way a bump looks.
    EXPECT_EQ(turn_light(light, {}, tilted(170, 0.7f), sun), Rgb{});
}

// r E(n) + t E(-n) of an open sheet, E the irradiance over pi of each light by itself.
TEST(TurnedLight, OfAThinWalledSurfaceIsThatOfBothItsSides) {
    const formats::SheetShares shares{{0.6f, 0.3f, 0.5f}, {0.2f, 0.5f, 0.5f}};
    const auto seen = [&](Rgb front, Rgb back) {
        return shares.reflect * front + shares.transmit * back;
    };
    const auto sky = [](Vec3 d) { return Rgb{1 + 0.6f * d.y, 1 + 0.6f * d.y, 1 - d.x / 3}; };
    const TurnedLight smooth = turned_light_of_sheet(make_turned_light(gradient()), shares);
    constexpr float kIrradiance = 5;
    const Vec3 toward = tilted(35, 0.7f);
    const TurnedLight sunny =
        turned_light_of_sheet(make_turned_light(sun_at(toward, kIrradiance, 0)), shares);
    const auto sun = [&](Vec3 d) {
        const float value =
            kIrradiance * std::max(dot(d, toward), 0.0f) / std::numbers::pi_v<float>;
        return Rgb{value, value, value};
    };
    for (const float side :
         {1.0f, -1.0f}) {  // the sun ahead of the side that is seen, or behind it
        const Vec3 n = side * tilted(5, 2);
        for (const float azimuth : {0.0f, 2.0f, 4.0f}) {
            const Vec3 m = side * tilted(25, azimuth);
            const Rgb of_sky = turn_light(smooth, seen(sky(n), sky(-1.0f * n)), n, m);
            const Rgb open_sky = seen(sky(m), sky(-1.0f * m));
            const Rgb of_sun = turn_light(sunny, seen(sun(n), sun(-1.0f * n)), n, m);
            const Rgb open_sun = seen(sun(m), sun(-1.0f * m));
            EXPECT_NEAR(of_sky.r, open_sky.r, 0.01f);
            EXPECT_NEAR(of_sky.b, open_sky.b, 0.01f);
            EXPECT_NEAR(of_sun.r / open_sun.r, 1, 0.02f) << side << ' ' << azimuth;
            EXPECT_NEAR(of_sun.g / open_sun.g, 1, 0.02f) << side << ' ' << azimuth;
        }
    }
}

// A sheet that transmits as much as it reflects looks alike from both sides under any light.
TEST(TurnedLight, OfASheetWithEqualSharesDoesNotKnowItsFront) {
    const TurnedLight light =
        turned_light_of_sheet(make_turned_light(sun_at(tilted(50, 1), 9, 0.4f)),
                              {{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}});
    const Rgb radiance{0.7f, 0.6f, 0.5f};
    const Vec3 n = tilted(20, 0), m = tilted(45, 3);
    const Rgb front = turn_light(light, radiance, n, m),
              back = turn_light(light, radiance, -1.0f * n, -1.0f * m);
    EXPECT_NEAR(front.r, back.r, 1e-5f);
    EXPECT_NE(front.r, radiance.r);
}

// The light of suns beyond the fourth becomes smooth: its mean over all normals stays, (r + t) / 4.
TEST(TurnedLight, OfASheetKeepsTheLightOfManySuns) {
    TurnedLight light;
    for (int i = 0; i < 8; ++i) {
        const float size = 1 + 0.25f * static_cast<float>(i);
        light.suns.push_back(
            {tilted(20.0f * static_cast<float>(i), static_cast<float>(i)), {size, size, size}});
    }
    const TurnedLight sheet =
        turned_light_of_sheet(light, {{0.5f, 0.5f, 0.5f}, {0.25f, 0.25f, 0.25f}});
    ASSERT_EQ(sheet.suns.size(), 8u);
    float all = 0, kept = 0;
    for (const TurnedLight::Sun& sun : light.suns)
        all += 0.75f * sun.light.g / 4;
    for (const TurnedLight::Sun& sun : sheet.suns)
        kept += sun.light.g / 4;
    EXPECT_NEAR(sheet.harmonics[0].g + kept, all, 1e-5f);
    EXPECT_GT(sheet.harmonics[0].g, 0.1f);
}

TEST(TurnedLight, LeavesASunOutWhereItDoesNotReach) {
    const TurnedLight light = make_turned_light(sun_at(tilted(50, 0), 20, 1));
    const Rgb sky{0.8f, 0.8f, 0.8f};  // below what the even sky gives: in shadow
    const Rgb turned = turn_light(light, sky, tilted(0, 0), tilted(50, 0));
    EXPECT_NEAR(turned.g, sky.g, 0.01f);  // texels barely lit by it count as smooth
}

TEST(TurnedLight, LeavesLightBeyondTheSkysAsItIs) {
    const TurnedLight light = make_turned_light(gradient());
    const Vec3 n = tilted(0, 0), m = tilted(60, 0);
    const Rgb open{1.6f, 1.6f, 1}, lamp{10, 10, 10};
    const Rgb without = turn_light(light, open, n, m), with = turn_light(light, open + lamp, n, m);
    EXPECT_NEAR(with.r - without.r, lamp.r, 0.02f);
}

TEST(TurnedLight, NeverExceedsWhatAnOpenSurfaceOfTheNewNormalGets) {
    const TurnedLight light = make_turned_light(sun_at(tilted(89, 0), 30, 0.01f));
    // Nearly grazing: the ratio of cosines is 57.
    const Rgb open = turn_light(light, {1, 1, 1}, tilted(0, 0), tilted(89, 0));
    EXPECT_LT(open.r, 30 / std::numbers::pi_v<float> + 1.01f);
}

}  // namespace
}  // namespace opaline::runtime
