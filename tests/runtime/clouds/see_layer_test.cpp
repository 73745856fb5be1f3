#include "runtime/clouds/see_layer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/clouds/layer_light.h"
#include "tests/runtime/clouds/lit_layer.h"

namespace opaline::runtime {
namespace {

using formats::Clouds;
using formats::Rgb;
using formats::Vec3;

constexpr std::uint32_t kHeapCells = 32;

// Heaps of up to `highest` with gaps between them. All share their tables.
Clouds heaps(bool repeats, float highest = 300) {
    static const Clouds kMade = [] {
        test::TestLayer layer = test::even_test_layer();
        layer.record.columns = layer.record.rows = kHeapCells;
        layer.record.haze = 2e-5f;
        return test::make_test_clouds(layer, [](std::uint32_t column, std::uint32_t row) {
            return std::max(0.0, std::sin(0.4 * column) * std::cos(0.6 * row + 1)) * 100;
        });
    }();
    Clouds clouds = kMade;
    clouds.records[0].highest = highest;
    if (!repeats) clouds.records[0].flags = formats::LayerRecord::kRadiosity;
    return clouds;
}

// The same without any thickness.
Clouds nothing(float highest) {
    Clouds clouds = heaps(true, highest);
    clouds.records[0].haze = 0;
    std::ranges::fill(clouds.thickness, std::uint16_t{0});
    return clouds;
}

const test::LitLayer& lit_heaps() {
    static const test::LitLayer lit(heaps(true), test::one_sun(0.5));
    return lit;
}

TEST(SeeLayer, TheMeanSheetIsWhereLightIsTaken) {
    const LayerSheet near{{1, 1, 1}, {0.5f, 0.5f, 0.5f}, 100}, far{{2, 2, 2}, {0, 0, 0}, 400};
    const LayerSheet mean = mean_sheet(std::array{near, far, LayerSheet{}, LayerSheet{}});
    EXPECT_FLOAT_EQ(mean.distance, 300);
    EXPECT_EQ(mean.radiance, (Rgb{0.75f, 0.75f, 0.75f}));
    EXPECT_EQ(mean.transmittance, (Rgb{0.625f, 0.625f, 0.625f}));
    EXPECT_EQ(mean_sheet(std::array{LayerSheet{}}).distance, 0);
}

TEST(SeeLayer, OfNoThicknessIsInvisible) {
    for (const float highest : {0.0f, 100.0f}) {
        const test::LitLayer lit(nothing(highest), test::sunny_day(0.1f, 0.5));
        for (const double sine : {1.0, 0.5, 0.0, -0.3}) {
            for (const float eye : {0.0f, 1000.0f, 1050.0f, 2000.0f}) {
                const SeenLayer seen =
                    see_layer(lit.light, {{0, eye, 0}, test::direction_of(sine, 0)});
                EXPECT_EQ(seen.radiance, Rgb{});
                EXPECT_EQ(seen.glow, Rgb{});
                EXPECT_EQ(seen.transmittance, (Rgb{1, 1, 1}));
                EXPECT_EQ(seen.sun_transmittance, (Rgb{1, 1, 1}));
            }
        }
        // Of a plane under an open sky: albedo / pi E.
        const float irradiance = 0.1f * std::numbers::pi_v<float> + 0.5f;
        EXPECT_NEAR(see_ground(lit.light, 3, 4, 0).g,
                    0.2016f / std::numbers::pi_v<float> * irradiance, 1e-3f);
    }
}

TEST(SeeLayer, EndsWhereTheRayEnds) {
    const test::LitLayer& lit = lit_heaps();
    const Vec3 up{0, 1, 0};
    const LayerRay whole{{1000, 0, 1200}, up};
    const SeenLayer all = see_layer(lit.light, whole);
    ASSERT_LT(all.transmittance.g, 0.9f);
    EXPECT_EQ(see_layer(lit.light, {whole.origin, up, 0, 999}).transmittance.g, 1);
    EXPECT_EQ(see_layer(lit.light, {whole.origin, up, 1400}).transmittance.g, 1);
    const float first = see_layer(lit.light, {whole.origin, up, 0, 1050}).transmittance.g;
    const float second = see_layer(lit.light, {whole.origin, up, 1050}).transmittance.g;
    EXPECT_NEAR(first * second / all.transmittance.g, 1, 1e-3f);
}

TEST(SeeLayer, FadesAtItsEdgesWithoutAStep) {
    for (const bool repeats : {true, false}) {
        const test::LitLayer lit(heaps(repeats), test::sunny_day(0.1f, 0.5));
        for (const float eye : {0.0f, 3000.0f}) {
            const double sine = eye > 0 ? -0.6 : 0.6;
            Rgb before;
            float largest = 0;
            for (int i = 0; i <= 4000; ++i) {
                const Vec3 at{-6000 + 3.0f * static_cast<float>(i), eye, 700};
                const Rgb now = see_through_layer(lit.scene(), {at, test::direction_of(sine, 2.5)});
                ASSERT_TRUE(test::is_lit(now));
                if (i > 0) largest = std::max(largest, std::abs(now.g - before.g));
                before = now;
            }
            // 3 m are 1 % of a cell.
            EXPECT_LT(largest, 0.02f) << repeats << " " << eye;
        }
    }
}

TEST(SeeLayer, IsFiniteForEveryRay) {
    const double none = 0, grazing = 1e-7;
    for (const double sun : {1.0, 0.3, 1e-4}) {
        for (const float highest : {300.0f, 1e-3f, 2e4f}) {
            for (const bool repeats : {true, false}) {
                const test::LitLayer lit(heaps(repeats, highest), test::sunny_day(0.1f, sun));
                for (const float height :
                     {0.0f, 999.0f, 1000.0f, 1000.0001f, 1150.0f, 1300.0f, 1e6f, -50.0f}) {
                    for (const double sine :
                         {1.0, sun, 0.3, 0.01, grazing, none, -grazing, -0.01, -0.3, -1.0}) {
                        for (const float side : {0.0f, 1e6f}) {
                            const LayerRay ray{{side, height, -side},
                                               test::direction_of(sine, 0.0)};
                            const Rgb color = see_through_layer(lit.scene(), ray);
                            EXPECT_TRUE(test::is_lit(color))
                                << sun << " " << highest << " " << height << " " << sine;
                            const SeenLayer seen = see_layer(lit.light, ray);
                            EXPECT_LE(seen.transmittance.g, 1);
                            EXPECT_LE(seen.sun_transmittance.g, seen.transmittance.g + 1e-6f);
                            // No brighter than a cloud can be under E = 1 and L = 0.1.
                            EXPECT_LT(seen.radiance.g, 5);
                        }
                    }
                }
            }
        }
    }
}

TEST(SeeLayer, IsContinuousWhereTheEyeEntersIt) {
    const test::LitLayer lit(heaps(true), test::sunny_day(0.1f, 0.5));
    const auto look = [&](float height, double sine) {
        return see_through_layer(lit.scene(), {{1000, height, 1200}, test::direction_of(sine, 2)})
            .g;
    };
    for (const double sine : {0.5, 0.1, -0.1, -0.5}) {
        EXPECT_NEAR(look(999.9f, sine), look(1000.1f, sine), 0.01f) << sine;
        EXPECT_NEAR(look(1299.9f, sine), look(1300.1f, sine), 0.01f) << sine;
    }
    EXPECT_NEAR(look(1150, 1e-4), look(1150, -1e-4), 0.01f);
}

TEST(SeeLayer, SurfacesHideTheSkyAndTheGroundHidesThem) {
    const test::LitLayer lit(heaps(true), test::sunny_day(0.1f, 0.5));
    const Rgb red{1, 0, 0};
    LayerRay down{{0, 500, 0}, {0, -1, 0}};
    for (const double end : {400.0, 500.2}) {  // above the ground, and a floor in its plane
        down.end = end;
        EXPECT_EQ(see_through_layer(lit.scene(), down, &red), red);
    }
    down.end = 600;
    EXPECT_NE(see_through_layer(lit.scene(), down, &red), red);
    // Toward the sun, without its light.
    LayerRay up{{0, 0, 0}, lit.light.sun.front().direction};
    up.end = 300;
    EXPECT_EQ(see_through_layer(lit.scene(), up, &red), red);
}

TEST(SeeLayer, SunThroughALayerIsItsDiscAndItsGlow) {
    const test::LitLayer lit(heaps(true), test::one_sun(0.5));
    const Vec3 sun = lit.light.sun.front().direction;
    float thinnest = 1;
    for (float x = 0; x < 4000; x += 50) {
        const LayerRay ray{{x, 0, 300}, sun};
        const SeenLayer seen = see_layer(lit.light, ray);
        const Rgb color = see_through_layer(lit.scene(), ray);
        const float disc =
            1 / static_cast<float>(formats::disc_solid_angle(lit.light.sky.suns[0].angular_radius));
        EXPECT_NEAR(color.g, seen.radiance.g + seen.glow.g + seen.sun_transmittance.g * disc,
                    2e-3f * color.g);
        thinnest = std::min(thinnest, seen.sun_transmittance.g);
    }
    EXPECT_LT(thinnest, 0.1f);
}

TEST(SeeLayer, SlopesThatFaceTheSunAreBrighterFromAbove) {
    // Ridges along z, both flanks of one slope, up to 300 m.
    Clouds ridges = heaps(true);
    for (std::uint32_t i = 0; i < kHeapCells * kHeapCells; ++i) {
        const std::uint32_t step = i % kHeapCells % 8;
        ridges.thickness[i] = static_cast<std::uint16_t>(20000 + 10000 * std::min(step, 8 - step));
    }
    const test::LitLayer lit(std::move(ridges), test::one_sun(0.3));
    const double cell = static_cast<double>(lit.light.record.size[0]) / kHeapCells;
    // Cell 2 of 8 rises toward +X and so faces away from the sun, cell 6 faces it.
    const auto look = [&](double column) {
        const auto x = static_cast<float>(lit.light.field.low_x + (column + 0.5) * cell);
        const LayerRay ray{{x, 3000, 0}, {0, -1, 0}};
        EXPECT_NEAR(march_layer(lit.light.field, ray, 1e-6f).thickness, 300 * 40000.0 / 65535, 20);
        return see_layer(lit.light, ray).radiance.g;
    };
    EXPECT_GT(look(6), 1.02f * look(2));
}

TEST(GroundLight, ShadowsLieAwayFromTheSun) {
    // One heap in the middle of nothing, the sun 45 degrees high toward +X: its shadow is at -1000.
    Clouds one = heaps(false, 200);
    for (std::uint32_t i = 0; i < kHeapCells * kHeapCells; ++i) {
        one.thickness[i] = i % kHeapCells / 4 == 4 && i / kHeapCells / 4 == 4 ? 65535 : 0;
    }
    const test::LitLayer lit(std::move(one), test::one_sun(std::sqrt(0.5)));
    const LitSun& sun = lit.light.sun.front();
    EXPECT_LT(direct_share(lit.light, sun, 500 - 1000, 500, 0).g, 0.8f);
    EXPECT_GT(direct_share(lit.light, sun, 500 + 1000, 500, 0).g, 0.999f);
    EXPECT_GT(direct_share(lit.light, sun, 500, 500 - 1000, 0).g, 0.999f);
}

TEST(LayerMarch, MeasuresWhatIsInsideOfAnEvenLayerExactly) {
    formats::LayerRecord record = test::even_test_layer().record;
    const std::vector<std::uint16_t> half(16, 32768);
    const LayerField field = make_layer_field(record, half, 0);
    const double thickness = 100.0 * 32768 / 65535;
    for (const double sine : {1.0, 0.3, 0.01, -0.01, -0.7}) {
        const LayerRay ray{{10, sine > 0 ? 0.0f : 3000.0f, 20}, test::direction_of(sine, 1)};
        const LayerMarch march = march_layer(field, ray, 1e-6f);
        EXPECT_NEAR(static_cast<double>(march.length) * std::abs(double(ray.direction.y)),
                    thickness, 2e-3);
        EXPECT_NEAR(static_cast<double>(march.thickness), thickness, 1e-3);
        const double middle = (sine > 0 ? 1000 + thickness / 2 : 2000 - thickness / 2) /
                              std::abs(double(ray.direction.y));
        EXPECT_NEAR(march.distance / middle, 1, 5e-3);
    }
}

}  // namespace
}  // namespace opaline::runtime
