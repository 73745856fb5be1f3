// Surfaces that light passes: alphaMode of a glTF file.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "bake/check/stored_luminance.h"
#include "bake/lights/true_irradiance.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/hidden_receivers.h"
#include "tests/support/media_bake.h"

// What the 95 % interval of a file's stated error promises: of 100 seeds, which draw the receivers
// to check and the resamples of the bootstrap, about 95 contain the error over all receivers.

namespace opaline::bake {
namespace {

// A floor under a plate that covers half of its sky.
formats::Scene floor_under_plate(formats::Material::AlphaMode mode, float alpha) {
    formats::Scene scene =
        tests::make_scene({tests::make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 2),
                           tests::make_quad({-1, 0.5f, 1}, {2, 0, 0}, {0, 0, -2}, 1)});
    scene.primitives[1].material = 1;
    scene.materials.push_back({.name = "Plate", .alpha_mode = mode, .alpha = alpha});
    return scene;
}

double floor_light(const formats::Scene& scene) {
    double sum = 0;
    for (const formats::Rgb& c :
         tests::relight_primitive(tests::bake_scene(scene, tests::small_bake()).asset, "white")) {
        sum += static_cast<double>(c.g);
    }
    return sum / static_cast<double>(scene.primitives[0].position.size());
}

TEST(Holes, OfAMaskLetAllLightPassAndThoseOfABlendTheirShare) {
    using enum formats::Material::AlphaMode;
    formats::Scene open = floor_under_plate(opaque, 1);
    open.primitives.pop_back();
    const double bare = floor_light(open), covered = floor_light(floor_under_plate(opaque, 1));
    EXPECT_LT(covered, 0.8 * bare);
    EXPECT_DOUBLE_EQ(floor_light(floor_under_plate(mask, 0.4f)), bare);
    EXPECT_DOUBLE_EQ(floor_light(floor_under_plate(mask, 0.6f)), covered);
    EXPECT_NEAR(floor_light(floor_under_plate(blend, 0.3f)), 0.7 * bare + 0.3 * covered,
                0.03 * bare);
}

// A white floor and a pane that absorbs nothing, under even light: what the pane keeps off the
// floor it mirrors back to it.
TEST(Holes, OfAWindowLetInWhatItsFacesDoNotMirror) {
    using enum formats::Material::AlphaMode;
    formats::Scene scene = floor_under_plate(opaque, 1);
    const double covered = floor_light(scene);
    scene.materials[0].base_color = scene.materials[1].base_color = {0, 0, 0};
    scene.materials[0].base_color = {0.2f, 0.2f, 0.2f};
    const double dark = floor_light(scene);
    scene.materials[1].sheet = formats::Sheet{.clear = 1};
    const double glazed = floor_light(scene);
    scene.primitives.pop_back();
    const double open = floor_light(scene);
    EXPECT_GT(covered, 0);
    EXPECT_LT(dark, 0.7 * open);
    // 0.83 of even light, 0.92 of what comes straight from above.
    EXPECT_TRUE(glazed > open - 0.2 * (open - dark) && glazed < open - 0.07 * (open - dark))
        << dark << " " << glazed << " " << open;
}

TEST(Holes, AreKeptInTheFileAndChangeNothingForWholeSurfaces) {
    using enum formats::Material::AlphaMode;
    const auto record_of = [](const formats::Scene& scene) {
        return tests::bake_scene(scene, tests::small_bake()).asset.holes.record;
    };
    const auto holes = record_of(floor_under_plate(mask, 0.4f));
    ASSERT_EQ(holes.size(), 1u);
    EXPECT_EQ(holes[0].primitive, 1u);
    EXPECT_EQ(holes[0].alpha, 0.4f);
    EXPECT_TRUE(record_of(floor_under_plate(opaque, 0.4f)).empty());
}

// Those of every receiver of an opaque scene, one per light, receiver by receiver.
std::vector<CheckedPair> check_every_receiver(const formats::Scene& scene,
                                              const formats::AssetView& asset,
                                              std::span<const TestLight> lights) {
    constexpr std::array<float, 1> kDiffuse{1.0f};
    const auto rays = RayScene::build(scene, 2);
    EXPECT_TRUE(rays);
    const auto receivers = replace_hidden_receivers(*rays, scene, make_vertex_receivers(scene), {});
    const ReflectionTruth truth = make_reflection_truth(lights);
    std::vector<CheckedPair> pairs;
    std::uint64_t traced = 0;
    for (std::uint32_t v = 0; v < receivers.size(); ++v) {
        const formats::PrimitiveRecord& primitive = formats::primitive_of(asset, v);
        append_pairs(relight_rows({asset.transport, primitive.rows(primitive.vertex_count),
                                   v - primitive.first_vertex},
                                  kDiffuse, lights),
                     eval_reflection(truth, *rays, receivers[v], traced), pairs);
    }
    return pairs;
}

// How many of 100 seeds state an interval around the error of all.
int count_covered(const std::vector<CheckedPair>& all, std::span<const TestLight> lights,
                  std::size_t checked) {
    std::vector<std::string> names;
    for (const TestLight& light : lights) {
        names.push_back(light.name);
    }
    const double truth = relative_rms(all);
    int covered = 0, below = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        EffectCheck check;
        check.effect = "direct";
        for (const std::uint32_t v : draw_evenly(all.size() / lights.size(), checked,
                                                 RandomStage::held_back_receivers, seed)) {
            const auto first = all.begin() + static_cast<std::ptrdiff_t>(v * lights.size());
            check.pairs.insert(check.pairs.end(), first,
                               first + static_cast<std::ptrdiff_t>(lights.size()));
        }
        const ErrorReport stated = summarise_checks(std::span(&check, 1), names, seed);
        covered += stated.ci95[0] <= truth && truth <= stated.ci95[1] ? 1 : 0;
        below += stated.ci95[1] < truth ? 1 : 0;
    }
    std::printf("error %g: %d of 100 intervals contain it, %d lie below\n", truth, covered, below);
    return covered;
}

// A ball alone errs everywhere alike; where things shadow each other few receivers make the error.
TEST(Coverage, IntervalOfAStatedErrorContainsItAsOftenAsItSays) {
    BakeOptions options = tests::small_bake();
    options.cubemap_size = 16;
    options.coefficients = 64;
    options.effects = {"direct"};
    const auto lights = make_test_lights(options.cubemap_size, 2);
    ASSERT_TRUE(lights);
    for (const formats::Scene& scene :
         {tests::make_scene({tests::make_sphere(3)}), tests::make_dented_ball()}) {
        const BakeResult baked = tests::bake_scene(scene, options);
        const auto all = check_every_receiver(scene, baked.asset.view(), *lights);
        const int covered = count_covered(all, *lights, baked.error.receivers_checked);
        EXPECT_GE(covered, 90);
        EXPECT_LE(covered, 99);
    }
}

}  // namespace

}  // namespace opaline::bake
