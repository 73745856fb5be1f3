#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "bake/check/check_model.h"
#include "bake/effects/interreflection/interreflection.h"
#include "bake/scene/lobe_record.h"
#include "tests/bake/exchange/bounce_support.h"

namespace opaline::bake {
namespace {

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
