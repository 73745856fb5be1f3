#include <gtest/gtest.h>

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

}  // namespace
}  // namespace opaline::tests
