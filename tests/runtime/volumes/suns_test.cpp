#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "formats/opal/cubemap.h"
#include "formats/opal/spherical_harmonics.h"
#include "runtime/volumes/moment_lights.h"
#include "runtime/volumes/suns.h"
#include "runtime/volumes/texel_integrals.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/volumes/synthetic_volume.h"
#include "tests/support/float_traps.h"

namespace opaline::runtime {
namespace {

using test::kSize;
constexpr std::size_t kTexels = formats::cubemap_texels(kSize);

// Even light of 1 a texel.
std::vector<double> even() {
    return std::vector<double>(3 * kTexels, 1.0);
}

void set_texel(std::vector<double>& integral, std::size_t texel, double r, double g, double b) {
    integral[3 * texel] = r;
    integral[3 * texel + 1] = g;
    integral[3 * texel + 2] = b;
}

TEST(Suns, TogetherWithTheRestAreTheWholeLightTexelByTexel) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> value(0, 1);
    for (const std::size_t bright : {0u, 1u, 3u, 8u, 9u, 30u}) {
        std::vector<double> integral = even();
        for (std::size_t i = 0; i < bright; ++i) {
            set_texel(integral, 11 * i + 5, 300 * value(generator), 300 * value(generator),
                      300 * value(generator));
        }
        const SplitLight split = split_suns(integral, kSize);
        EXPECT_LE(split.sun.size(), kMaxSuns);
        EXPECT_EQ(split.sun.empty(), bright == 0);
        std::vector<double> sum = split.rest;
        for (const Sun& sun : split.sun) {
            for (std::size_t band = 0; band < 3; ++band) {
                EXPECT_GE(sun.light[band], 0);
                EXPECT_GE(split.rest[3 * sun.texel + band], 0);
                sum[3 * sun.texel + band] += sun.light[band];
            }
        }
        for (std::size_t i = 0; i < sum.size(); ++i) {
            EXPECT_NEAR(sum[i], integral[i], 1e-15 * integral[i]);
        }
    }
}

TEST(Suns, AreTheBrightestTexelsInTheirPlaceAndColour) {
    std::vector<double> integral = even();
    constexpr std::size_t texel = 3 * kSize * kSize + 2 * kSize + 5;
    set_texel(integral, texel, 400, 200, 100);
    set_texel(integral, 7, 2, 2, 2);  // below 1/128 of the whole
    const SplitLight split = split_suns(integral, kSize);
    ASSERT_EQ(split.sun.size(), 1u);
    const Sun& sun = split.sun[0];
    EXPECT_EQ(sun.texel, texel);
    EXPECT_GT(dot(sun.direction, formats::texel_direction(kSize, 3, 2, 5)), 1 - 1e-6f);
    EXPECT_NEAR(sun.light[0], 2 * sun.light[1], 1e-12);
    EXPECT_NEAR(sun.light[1], 2 * sun.light[2], 1e-12);
    EXPECT_EQ(sun.light[1], 200);
    const LightVector alone = make_sun_light(sun, kSize);
    for (std::size_t band = 0; band < 3; ++band) {
        const std::vector<double> texels = tests::texels_of(alone, band);
        for (std::size_t j = 0; j < kTexels; ++j) {
            EXPECT_NEAR(texels[j], j == texel ? sun.light[band] : 0, 1e-4);
        }
    }
}

TEST(Suns, EvenLightAndManyTexelsOfOneBrightnessHaveNone) {
    for (const std::uint32_t n : {8u, 16u, 32u}) {
        EXPECT_TRUE(split_suns(texel_integrals(test::white_light(n)), n).sun.empty()) << n;
    }
    std::vector<double> integral = even();
    for (std::size_t i = 0; i < kMaxSuns + 1; ++i) {
        set_texel(integral, 31 * i, 1000, 1000, 1000);
    }
    EXPECT_TRUE(split_suns(integral, kSize).sun.empty());
}

// Its light stands in the four texels around it, up to 9 degrees away from where it is.
TEST(Suns, OfASmallLightStandWhereItIs) {
    std::mt19937 generator(8);
    std::normal_distribution<float> normal;
    for (const std::uint32_t n : {8u, 16u, 32u}) {
        for (int i = 0; i < 50; ++i) {
            formats::Environment sky;
            const formats::Vec3 toward =
                formats::normalize({normal(generator), normal(generator), normal(generator)});
            sky.discs.push_back({toward, 0.00465f, {1, 1, 1}});
            const SplitLight split = split_suns(texel_integrals(project_environment(sky, n)), n);
            ASSERT_FALSE(split.sun.empty());
            for (const Sun& sun : split.sun) {
                const float off = length(sun.direction - toward) * static_cast<float>(n);
                EXPECT_LT(off, 0.2f) << n;  // of 2 a texel
            }
        }
    }
}

// Two small lights with a texel between them do not draw each other's suns away.
TEST(Suns, OfLightsFarApartKeepTheirPlaces) {
    std::vector<double> integral = even();
    const std::uint32_t column[] = {1, 3};
    for (const std::uint32_t c : column) {
        set_texel(integral, std::size_t{3} * kSize * kSize + 3 * kSize + c, 400, 400, 400);
    }
    const SplitLight split = split_suns(integral, kSize);
    ASSERT_EQ(split.sun.size(), 2u);
    for (std::size_t s = 0; s < 2; ++s) {
        const formats::Vec3 own = formats::texel_direction(kSize, 3, 3, column[s]);
        EXPECT_GT(dot(split.sun[s].direction, own), 1 - 1e-6f);
    }
}

// Twelve lights rise and fall so that each is a sun for a while. If a texel joined with all of its
// light, a sun would begin with at least 1/128 of the whole.
TEST(Suns, BeginAndEndWithNothing) {
    constexpr int kFrames = 20000;
    std::vector<double> before;
    double largest_step = 0, brightest = 0;
    std::size_t most = 0;
    for (int frame = 0; frame <= kFrames; ++frame) {
        std::vector<double> integral = even();
        for (std::size_t i = 0; i < 12; ++i) {
            const double phase = 2 * std::numbers::pi * frame / kFrames;
            const double wave =
                1 + std::sin(static_cast<double>(i % 4 + 1) * phase + static_cast<double>(i));
            set_texel(integral, 29 * i, 60 * wave, 50 * wave, 40 * wave);
        }
        const SplitLight split = split_suns(integral, kSize);
        most = std::max(most, split.sun.size());
        std::vector<double> light(kTexels);
        for (const Sun& sun : split.sun) {
            light[sun.texel] = sun.light[0];
            brightest = std::max(brightest, sun.light[0]);
        }
        for (std::size_t j = 0; j < before.size(); ++j) {
            largest_step = std::max(largest_step, std::abs(light[j] - before[j]));
        }
        before = std::move(light);
    }
    EXPECT_EQ(most, kMaxSuns);
    EXPECT_GT(brightest, 40);
    // The lights themselves move by up to 60 * 4 * 2 pi / kFrames = 0.075, the threshold as much.
    EXPECT_LT(largest_step, 0.6);
}

TEST(Suns, OfLightThatIsNoLightAreFinite) {
    const opaline::tests::UntrappedFloats untrapped;  // what is given overflows
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(split_suns(std::vector<double>(3 * kTexels, 0.0), kSize).sun.empty());
    EXPECT_TRUE(split_suns(std::vector<double>(3 * kTexels, -1.0), kSize).sun.empty());
    EXPECT_TRUE(split_suns(std::vector<double>(3 * kTexels, nan), kSize).sun.empty());
    std::vector<double> integral = even();
    set_texel(integral, 1, nan, 1, 1);
    set_texel(integral, 2, infinity, 1, 1);
    set_texel(integral, 3, infinity, -infinity, 1);
    set_texel(integral, 4, -1e300, -1e300, -1e300);
    set_texel(integral, 5, 1e300, 1e300, 1e300);
    const SplitLight split = split_suns(integral, kSize);
    ASSERT_EQ(split.sun.size(), 1u);
    EXPECT_EQ(split.sun[0].texel, 5u);
    EXPECT_TRUE(std::isfinite(split.sun[0].light[0]));
    const LightVector light = make_sun_light(split.sun[0], kSize);
    EXPECT_TRUE(std::ranges::all_of(light.rgba, [](float x) { return std::isfinite(x); }));
}

// The moments hold these phase functions to 1 %: suns would cost time and change nothing.
TEST(Suns, AreNotNeededWherePolynomialsAreThePhaseFunction) {
    test::TestVolume volume;
    const auto needs = [&](std::uint32_t terms, std::array<float, 5> moment,
                           std::function<double(double)> phase) {
        formats::Volumes volumes = test::make_volumes(kSize);
        volume.single_terms = terms;
        volume.moment = moment;
        volume.phase = std::move(phase);
        test::add_volume(volumes, volume);
        return needs_suns(volumes.records[0], volumes.view().phase_of(0));
    };
    const auto isotropic = [](double) { return 1.0; };
    const auto rayleigh = [](double c) { return 1 + c * c; };
    const auto greenstein = [](double g) {
        return [g](double c) { return std::pow(1 + g * g - 2 * g * c, -1.5); };
    };
    EXPECT_FALSE(needs(1, {1, 0, 0, 0, 0}, isotropic));
    EXPECT_FALSE(needs(9, {1, 0, 0.1f, 0, 0}, rayleigh));
    EXPECT_FALSE(needs(25, {1, 0.1f, 0.01f, 1e-3f, 1e-4f}, greenstein(0.1)));
    EXPECT_TRUE(needs(25, {1, 0.5f, 0.25f, 0.125f, 0.0625f}, greenstein(0.5)));
    EXPECT_TRUE(needs(25, {1, 0, 0, 0, 0}, rayleigh));
    // Of degree 2 alone: moments of higher degrees do not count.
    EXPECT_TRUE(needs(9, {1, 0.4f, 0.16f, 0.064f, 0.0256f}, greenstein(0.4)));
    EXPECT_FALSE(needs(0, {1, 0, 0, 0, 0}, rayleigh));
}

std::vector<LightVector> moments_of(const LightVector& light, std::uint32_t count,
                                    unsigned threads = 0) {
    return make_moment_lights(texel_integrals(light), light.n, count, threads);
}

TEST(MomentLights, WhiteLightHasOnlyAMean) {
    const auto moments = moments_of(test::white_light(16), 25);
    ASSERT_EQ(moments.size(), 25u);
    EXPECT_NEAR(tests::flux(moments[0], 0), std::sqrt(4 * std::numbers::pi), 1e-5);
    for (std::size_t k = 1; k < 25; ++k) {
        // Degree 4 has the cube's symmetry: there centres of texels err by their size squared.
        EXPECT_NEAR(tests::flux(moments[k], 0), 0, k < 16 ? 1e-5 : 8e-3) << k;
    }
}

TEST(MomentLights, OfATexelAreTheHarmonicsOfItsCentre) {
    constexpr std::uint32_t n = 8, texel = 2 * n * n + 3 * n + 6;
    const LightVector light = test::texel_light(n, texel, {2, 3, 5});
    const auto moments = moments_of(light, 25);
    std::array<float, 25> expected{};
    formats::eval_spherical_harmonics(formats::texel_direction(n, 2, 3, 6), expected);
    for (std::size_t band = 0; band < 3; ++band) {
        const double whole = tests::flux(light, band);
        EXPECT_GT(whole, 0);
        for (std::size_t k = 0; k < 25; ++k) {
            EXPECT_NEAR(tests::flux(moments[k], band), expected[k] * whole, 1e-6 * whole) << k;
            EXPECT_NEAR(tests::texels_of(moments[k], band)[texel], expected[k] * whole,
                        1e-6 * whole);
        }
    }
}

}  // namespace

}  // namespace opaline::runtime
