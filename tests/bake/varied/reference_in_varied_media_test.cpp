#include <gtest/gtest.h>

#include <numbers>

#include "tests/bake/varied/varied_body.h"

namespace opaline::tests {
namespace {

bake::Moments look_along_rod(const formats::Medium& medium, bake::TermSet terms,
                             std::uint32_t samples) {
    const auto rod = make_fixture(make_rod(medium), make_white_sky());
    return look(rod->space({terms}), {-2, 0.013f, 0.008f}, {1, 0, 0}, samples);
}

TEST(ReferenceInVariedMedium, LightPassesARodUnscatteredAsTheIntegralOfItsDensitySays) {
    for (const float sigma_t : {0.5f, 3.0f}) {
        const bake::Moments seen =
            look_along_rod(make_medium(sigma_t, 1, 0, 1), bake::TermSet::unscattered, 60000);
        EXPECT_NEAR(seen.mean.y, std::exp(-sigma_t), 4 * standard_error(seen) + 0.002) << sigma_t;
        EXPECT_LT(standard_error(seen), 0.003);
    }
}

// Along the rod, the light scattered to the line at each point is that which the transmittance from
// everywhere lets through: here by the trapezium rule, direction by direction.
double scattered_once_along_rod(double sigma_t, double albedo, double y, double z) {
    constexpr int kAlong = 200, kPolar = 48, kAround = 24;
    constexpr double kHalf = static_cast<double>(kRodHalfWidth);
    // Of sigma_t = 1, from x by the way s with the cosine c to the rod's axis.
    const auto depth = [](double x, double s, double c) {
        constexpr int kSteps = 16;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            sum += density_in_rod(x + (i + 0.5) / kSteps * s * c) * s / kSteps;
        }
        return sum;
    };
    double seen = 0;
    for (int i = 0; i < kAlong; ++i) {
        const double x = -1 + 2 * (i + 0.5) / kAlong;
        double arriving = 0;
        for (int p = 0; p < kPolar; ++p) {
            const double c = -1 + 2 * (p + 0.5) / kPolar, sine = std::sqrt(1 - c * c);
            for (int a = 0; a < kAround; ++a) {
                const double phi = 2 * std::numbers::pi * (a + 0.5) / kAround;
                const auto to_side = [&](double at, double w) {
                    return w > 0 ? (kHalf - at) / w : (-kHalf - at) / w;
                };
                const double s =
                    std::min({to_side(y, sine * std::cos(phi)), to_side(z, sine * std::sin(phi)),
                              ((c > 0 ? 1 : -1) - x) / c});
                arriving += std::exp(-sigma_t * depth(x, s, c)) / (kPolar * kAround);
            }
        }
        seen += 2.0 / kAlong * sigma_t * density_in_rod(x) *
                std::exp(-sigma_t * depth(-1, x + 1, 1)) * albedo * arriving;
    }
    return seen;
}

TEST(ReferenceInVariedMedium, LightScatteredOnceAlongARodIsThatOfQuadrature) {
    const double expected = scattered_once_along_rod(3, 0.7, 0.013, 0.008);
    EXPECT_GT(expected, 0.3);
    // At index 1 light is sampled at each event, through a medium that varies; beside it, it is
    // not.
    for (const float eta : {1.0f, 1.0002f}) {
        const bake::Moments seen =
            look_along_rod(make_medium(3, 0.7f, 0, eta), bake::TermSet::single, 80000);
        EXPECT_NEAR(seen.mean.y, expected, 4 * standard_error(seen) + 0.004) << eta;
        EXPECT_LT(standard_error(seen), 0.003) << eta;
    }
}

TEST(ReferenceInVariedMedium, FurnaceOfAlbedoOneIsWhiteWhateverTheDensity) {
    for (const float eta : {1.0f, 1.4f}) {
        formats::Medium medium = make_medium(3, 1, 0.3f, eta);
        medium.sigma_s = {1, 3, 9};
        Scene scene = make_mapped_ball(medium);
        variation_of(scene).density = add_inner_texture(scene, make_rising_image());
        const auto ball = make_fixture(std::move(scene), make_white_sky());
        const bake::Moments seen =
            look(ball->space(), {0.3f, 2, 0.2f}, {0, -1, 0}, eta == 1 ? 160000 : 40000);
        for (int band = 0; band < 3; ++band) {
            EXPECT_NEAR(seen.mean[band], 1, 4 * std::sqrt(seen.variance_of_mean()[band]) + 1e-5);
            EXPECT_LT(std::sqrt(seen.variance_of_mean()[band]), 0.007);
        }
    }
}

// Where light is sampled at events and where it is not: two estimators of the same.
TEST(ReferenceInVariedMedium, AWhiteFieldIsTheHomogeneousMedium) {
    const formats::Medium medium = make_medium(3, 0.8f, 0, 1);
    Scene scene = make_mapped_ball(medium);
    variation_of(scene).color = add_inner_texture(scene, make_even_image(255));
    const auto varied = make_fixture(std::move(scene), make_white_sky());
    const auto plain =
        make_fixture(make_translucent_scene({make_sphere(3)}, medium), make_white_sky());
    const auto seen = [](const ReferenceFixture& fixture) {
        return look(fixture.space(), {0.3f, 2, 0.2f}, {0, -1, 0}, 20000);
    };
    const bake::Moments a = seen(*varied), b = seen(*plain);
    EXPECT_NEAR(a.mean.y, b.mean.y, 1e-5);
}

}  // namespace
}  // namespace opaline::tests
