#include <gtest/gtest.h>

#include <cmath>

#include "bake/accuracy/check_model.h"
#include "bake/effects/interreflection/interreflection_knobs.h"
#include "bake/scene/lobe_record.h"
#include "tests/bake/interreflection/bounce_support.h"

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

// An integrating sphere: from any place of its wall the hole has the same form factor f, its share
// of the sphere, so that under an even sky L = rho (f + (1 - f) L). Three fifths of the light are
// bounced. Vertices stand apart from the facets that receive light, and the cube map resolves the
// hole's edge coarsely: the bounds are for that.
TEST(BounceFurnace, TheWallOfAnIntegratingSphereIsEven) {
    formats::Primitive wall = tests::make_sphere(3);
    for (glm::vec3& n : wall.normal) {
        n = -n;
    }
    std::vector<std::uint32_t> kept;
    double all = 0, hole = 0;
    for (std::size_t t = 0; t < wall.index.size(); t += 3) {
        const glm::vec3 a = wall.position[wall.index[t]], b = wall.position[wall.index[t + 1]],
                        c = wall.position[wall.index[t + 2]];
        const double area = static_cast<double>(glm::length(glm::cross(b - a, c - a)));
        all += area;
        if (a.y + b.y + c.y > 3 * 0.5f) {
            hole += area;
        } else {
            kept.insert(kept.end(), {wall.index[t], wall.index[t + 2], wall.index[t + 1]});
        }
    }
    wall.index = kept;
    formats::Scene sphere = tests::make_scene({wall});
    sphere.materials[0].base_color = {0.8f, 0.8f, 0.8f};
    const BakeResult baked =
        tests::bake_scene(sphere, furnace_options({"direct", "interreflection"}));
    const double f = hole / all;
    std::vector<formats::Rgb> radiance;
    const auto of_all = tests::relight(baked.asset.view(), "white");
    for (std::size_t v = 0; v < of_all.size(); ++v) {
        if (wall.position[v].y < 0.4f) {
            radiance.push_back(of_all[v]);
        }
    }
    const Deviation d = deviation_from(0.8 * f / (1 - 0.8 * (1 - f)), radiance);
    EXPECT_LT(d.rms, 0.03);
    EXPECT_LT(std::abs(d.mean), 0.01);
}

}  // namespace
}  // namespace opaline::bake
