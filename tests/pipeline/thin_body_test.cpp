// Single scattering in isolated convex bodies: nothing occludes the light, but rays must still find
// the far side of the body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

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

}  // namespace
}  // namespace opaline::bake
