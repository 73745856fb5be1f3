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
