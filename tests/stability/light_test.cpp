#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "bake/encode/select_coefficients.h"
#include "bake/physics/fresnel.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

using formats::Rgb;
using tests::bake_scene;
using tests::make_grey_medium;
using tests::relative_rms;
using tests::small_bake;

// Baked once for all cases.
const BakeResult& bake_lit_ball(std::uint32_t coefficients) {
    static std::map<std::uint32_t, BakeResult> bakes;
    const auto known = bakes.find(coefficients);
    if (known != bakes.end()) return known->second;
    BakeOptions options = small_bake();
    options.cubemap_size = 16;
    options.coefficients = coefficients;
    return bakes[coefficients] = bake_scene(
               tests::make_translucent_scene({tests::make_sphere(2)}, make_grey_medium(10, 0.2f)),
               options);
}

std::vector<Rgb> relight_by_map(const formats::Asset& asset, const std::vector<Rgb>& map) {
    return tests::relight(asset.view(), runtime::project_cubemap(map, 16));
}

TEST(Light, ATexelAsBrightAsTheSunActsAsItDoesScaledDown) {
    const BakeResult& result = bake_lit_ball(128);
    for (const std::size_t texel : {0u, 700u, 1535u}) {
        std::vector<Rgb> map(formats::cubemap_texels(16), Rgb{0, 0, 0});
        map[texel] = {1, 0.9f, 0.8f};
        const std::vector<Rgb> one = relight_by_map(result.asset, map);
        for (const float bright : {1e5f, 1e7f}) {
            map[texel] = bright * Rgb{1, 0.9f, 0.8f};
            std::vector<Rgb> many = relight_by_map(result.asset, map);
            for (Rgb& c : many) {
                c = (1 / bright) * c;
            }
            EXPECT_LT(relative_rms(many, one), 1e-6) << texel;
        }
    }
}

// The grey of a map that is bright everywhere else must survive beside the texel.
TEST(Light, AddingASunAddsItsOwnPictureAndNothingElse) {
    const BakeResult& result = bake_lit_ball(128);
    std::vector<Rgb> sky(formats::cubemap_texels(16), Rgb{1, 1, 1});
    std::vector<Rgb> sun(sky.size(), Rgb{0, 0, 0});
    sun[300] = {1e5f, 1e5f, 1e5f};
    std::vector<Rgb> both = sky;
    both[300] = {1 + 1e5f, 1 + 1e5f, 1 + 1e5f};
    const auto a = relight_by_map(result.asset, sky), b = relight_by_map(result.asset, sun),
               sum = relight_by_map(result.asset, both);
    for (std::size_t v = 0; v < sum.size(); ++v) {
        if (b[v].g > 0) {  // else clamped
            ASSERT_NEAR(sum[v].g, a[v].g + b[v].g, 1e-5 * sum[v].g) << v;
        }
    }
}

// A coefficient a thousand times the others leaves them codes: steps grow with the value.
TEST(Codes, ADominantCoefficientCostsNoMoreThanHalfAStepOfEach) {
    constexpr std::uint32_t kSize = 8;
    std::vector<float> row(formats::cubemap_texels(kSize));
    for (std::size_t k = 0; k < row.size(); ++k) {
        row[k] = std::sin(static_cast<float>(k) + 1);
    }
    for (const std::size_t dominant : {std::size_t{0}, std::size_t{1}, std::size_t{77}}) {
        std::vector<float> values = row;
        values[dominant] = 1000;
        formats::SparseRows rows = formats::make_sparse_rows(kSize, 8);
        ASSERT_TRUE(formats::append_row(
            rows, select_coefficients(make_selector(kSize, kAllCoefficients), values, 1)));
        std::vector<float> stored(values.size());
        formats::decode_row(rows.view(), {0, 1, 1, 0, 0}, 0, 0, stored);
        double error = 0, allowed = 0;
        for (std::size_t k = 0; k < values.size(); ++k) {
            const double light = std::cos(0.7 * static_cast<double>(k));
            const bool average = k % (kSize * kSize) == 0;
            const double scale = average ? rows.average_scale[0] : rows.detail_scale[0];
            const double steps = average ? 0.5 : std::sqrt(std::abs(values[k]) / scale) + 0.5;
            error += light * (stored[k] - values[k]);
            allowed += std::abs(light) * 1.001 * steps * scale;
            if (!average && k != dominant) {
                EXPECT_NEAR(stored[k], values[k], 0.25) << "lost beside " << dominant;
            }
        }
        EXPECT_LE(std::abs(error), allowed) << dominant;
        // Averages stand apart, so that a dominant one costs the details nothing.
        if (dominant == 0) {
            for (std::size_t k = 1; k < 64; ++k) {
                ASSERT_NEAR(stored[k], values[k], 1.0 / 127 * 1.001) << k;
            }
        }
    }
}

// Truncated rows ring below zero under a small light; what is shown is clamped, its mean over
// directions of the light is not biased by the clamp of any single term.
TEST(Truncation, RingingBelowZeroIsClampedAtTheEndOnly) {
    const BakeResult &few = bake_lit_ball(16), &all = bake_lit_ball(kAllCoefficients);
    std::vector<double> sum_few(162), sum_all(162);
    bool clamped = false;
    for (std::size_t texel = 0; texel < formats::cubemap_texels(16); texel += 3) {
        std::vector<Rgb> map(formats::cubemap_texels(16), Rgb{0, 0, 0});
        map[texel] = {1, 1, 1};
        const runtime::LightVector light = runtime::project_cubemap(map, 16);
        runtime::ShadeOptions shown;
        shown.fresnel = false;  // keeps the sign
        std::vector<Rgb> a(162), b(162);
        runtime::shade(few.asset.view(), light, a, shown);
        runtime::shade(all.asset.view(), light, b, shown);
        const std::vector<Rgb> clamps = tests::relight(few.asset.view(), light);
        for (std::size_t v = 0; v < 162; ++v) {
            sum_few[v] += a[v].g;
            sum_all[v] += b[v].g;
            clamped = clamped || a[v].g < 0;
            ASSERT_GE(clamps[v].g, 0);
        }
    }
    EXPECT_TRUE(clamped) << "nothing rings: the test tests nothing";
    double error = 0, reference = 0;
    for (std::size_t v = 0; v < 162; ++v) {
        error += std::pow(sum_few[v] - sum_all[v], 2);
        reference += std::pow(sum_all[v], 2);
    }
    EXPECT_LT(std::sqrt(error / reference), 0.02);
}

// Haar wavelets do not reach over the edge of a face: lights there must not cost more.
TEST(Seams, LightsOnAnEdgeOfTheCubeErrHardlyMoreThanInTheMiddleOfAFace) {
    const BakeResult &some = bake_lit_ball(64), &all = bake_lit_ball(kAllCoefficients);
    const auto error = [&](const char* light) {
        return relative_rms(tests::relight(some.asset.view(), light),
                            tests::relight(all.asset.view(), light));
    };
    const double middle = std::max(error("sun:0,0"), error("sun:90,0"));
    const double edge = std::max(error("sun:45,0"), error("sun:135,0"));
    EXPECT_LT(edge, 3 * middle);
    EXPECT_LT(edge, 0.15);
}

using tests::all_finite;
using tests::relight_primitive;

BakeResult bake_ball(float eta) {
    return bake_scene(
        tests::make_translucent_scene({tests::make_sphere(2)}, make_grey_medium(20, 0.2f, eta)),
        small_bake());
}

TEST(Boundary, IndexOfOneIsTheLimitOfIndicesBesideIt) {
    const auto one = relight_primitive(bake_ball(1).asset, "studio");
    for (const float eta : {0.9999f, 0.999999f, 1.000001f, 1.0001f}) {
        EXPECT_LT(relative_rms(relight_primitive(bake_ball(eta).asset, "studio"), one), 4e-3)
            << eta;
    }
}

TEST(Boundary, IndicesFromAThirdToThreeGiveSoundRows) {
    for (const float eta : {1.0f / 3, 0.5f, 0.8f, 2.0f, 3.0f}) {
        const BakeResult result = bake_ball(eta);
        EXPECT_TRUE(all_finite(result.asset)) << eta;
        double mean = 0;
        for (const Rgb c : relight_primitive(result.asset, "white")) {
            ASSERT_GE(c.g, 0) << eta;
            mean += c.g / 162.0;
        }
        // Seen along the normal, where most light leaves: up to Ft(1) / (1 - F_ext) of the mean.
        EXPECT_GT(mean, 0.01) << eta;
        EXPECT_LT(mean, 1.1 * fresnel_transmittance(1, eta) / (1 - fresnel_moments(eta).external))
            << eta;
    }
}

}  // namespace

}  // namespace opaline::bake
