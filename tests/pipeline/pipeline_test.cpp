#include "bake/pipeline/pipeline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include "tests/support/bake.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

BakeOptions small_options() {
    BakeOptions options;
    options.cubemap_size = 16;
    options.coefficients = 64;
    options.threads = 2;
    return options;
}

// A white furnace from end to end: scene, rays, wavelets, file rows, light, dot product.
TEST(Pipeline, OpenSurfacesUnderWhiteShineWithTheirAlbedo) {
    auto scene = tests::make_scene(
        {tests::make_sphere(2, 0.3f, {0, 100, 0}),
         tests::transformed(tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 2),
                            tests::some_rotation(), 1, {0, -100, 0})});
    scene.materials[0].base_color = {0.2f, 0.5f, 0.8f};
    double previous = 1;
    for (const std::uint32_t n : {8u, 16u, 32u}) {
        BakeOptions options;
        options.quality = Quality::reference;  // all coefficients, 16 bits
        options.cubemap_size = n;
        const BakeResult result = tests::bake_scene(scene, options);
        double worst = 0;
        for (const formats::Rgb c : tests::relight(result.asset.view(), "white")) {
            worst = std::max<double>({worst, std::abs(c.r / 0.2f - 1), std::abs(c.g / 0.5f - 1),
                                      std::abs(c.b / 0.8f - 1)});
        }
        EXPECT_LT(worst, previous) << n;
        previous = worst;
    }
    EXPECT_LT(previous, 1e-3);
}

TEST(Pipeline, VertexOfAFloorLiesInTheShadowOfWhatStandsOnIt) {
    BakeOptions options = small_options();
    options.coefficients = kAllCoefficients;
    options.effects = {"direct"};
    const BakeResult result = tests::bake_scene(tests::make_dented_ball(), options);
    const auto radiance = tests::relight(result.asset.view(), "sun:0,89");
    const formats::PrimitiveRecord& floor = result.asset.primitives[1];
    const formats::Rgb below = radiance[floor.first_vertex + 10 * 21 + 10];
    const formats::Rgb corner = radiance[floor.first_vertex];
    EXPECT_LT(below.g, 0.02f);
    EXPECT_NEAR(corner.g, std::sin(89 * std::numbers::pi / 180), 0.02f);
}

TEST(Pipeline, BlackSurfacesCostNoRays) {
    auto scene = tests::make_dented_ball();
    const BakeResult grey = tests::bake_scene(scene, small_options());
    scene.materials[0].base_color = {0, 0, 0};
    const BakeResult black = tests::bake_scene(scene, small_options());
    const auto direct_rays = [](const BakeResult& result) {
        std::uint64_t rays = 0, stages = 0;
        for (const StageReport& stage : result.stages) {
            if (stage.name.starts_with("rows of ")) {
                rays += stage.rays;
                ++stages;
            }
        }
        EXPECT_EQ(stages, 2u);
        return rays;
    };
    EXPECT_GT(direct_rays(grey), 100000u);
    EXPECT_EQ(direct_rays(black), 0u);
    EXPECT_TRUE(black.asset.transport.index16.empty());
}

TEST(Pipeline, CancellingEndsInAnInterruptedErrorAndNoResult) {
    const std::atomic<bool> cancel = true;
    Context context;
    context.cancel = &cancel;
    const auto result =
        run_bake(tests::make_dented_ball(), *resolve_knobs(small_options()), context);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, formats::ErrorKind::interrupted);
}

TEST(Pipeline, ProgressEndsAtTheNumberOfReceivers) {
    const auto scene = tests::make_dented_ball();
    Context context;
    std::uint64_t last = 0, total = 0;
    context.on_progress = [&](const Progress& progress) {
        EXPECT_GT(progress.done, last);
        last = progress.done;
        total = progress.total;
    };
    ASSERT_TRUE(run_bake(scene, *resolve_knobs(small_options()), context));
    EXPECT_EQ(last, total);
    EXPECT_EQ(total, scene.primitives[0].position.size() + scene.primitives[1].position.size());
}

TEST(Pipeline, WithoutRandomRaysTheSeedChoosesTheCheckedReceiversOnly) {
    const auto scene = tests::make_dented_ball();
    BakeOptions options = small_options();
    options.effects = {"direct"};
    const BakeResult a = tests::bake_scene(scene, options);
    options.seed = 1;
    const BakeResult b = tests::bake_scene(scene, options);
    EXPECT_EQ(a.asset.transport.code8, b.asset.transport.code8);
    EXPECT_NE(a.error.rms_relative, b.error.rms_relative);
}

}  // namespace
}  // namespace opaline::bake
