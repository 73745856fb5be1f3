// What the file shows between its receivers is part of its measured error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/check/stored_luminance.h"
#include "bake/check/surface_probes.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;

// A ball whose shadows fall onto a floor of cells x cells.
formats::Scene ball_over_floor(std::uint32_t cells) {
    auto floor = tests::make_quad({-2.5f, 0, -2.5f}, {0, 0, 5}, {5, 0, 0}, cells);
    floor.name = "floor";
    return tests::make_scene({tests::make_sphere(4, 1, {0, 1.1f, 0}), floor});
}

BakeResult bake_preview(const formats::Scene& scene) {
    BakeOptions options;
    options.threads = 2;
    options.effects = {"direct"};
    return tests::bake_scene(scene, options);
}

TEST(Between, ShadowThatAFloorOfFourVerticesCannotShowIsMeasuredAndSaidAndAFineFloorShowsIt) {
    const BakeResult coarse = bake_preview(ball_over_floor(1));
    EXPECT_LT(coarse.error.at_receivers.rms_relative, 0.05) << "the vertices themselves are right";
    EXPECT_GT(coarse.error.between.rms_relative, 0.2);
    EXPECT_GT(coarse.error.rms_relative, 0.1) << "the whole covers both";
    EXPECT_EQ(coarse.error.worst_between, 1u);
    EXPECT_THAT(coarse.warnings, Contains(Field(&formats::Diagnostic::where, HasSubstr("floor"))));
    const ErrorReport fine = bake_preview(ball_over_floor(64)).error;
    EXPECT_LT(fine.between.rms_relative, 0.4 * coarse.error.between.rms_relative);
    EXPECT_LT(fine.between.rms_relative, 2.5 * fine.at_receivers.rms_relative);
}

TEST(Between, OpenFlatSurfaceIsAsRightBetweenItsVerticesAsThere) {
    const BakeResult result =
        bake_preview(tests::make_scene({tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})}));
    EXPECT_NEAR(result.error.between.rms_relative, result.error.at_receivers.rms_relative, 1e-6);
    EXPECT_TRUE(result.warnings.empty());
}

TEST(Between, SmoothBallInAMediumIsNearlyAsRightBetweenItsVertices) {
    const auto scene =
        tests::make_translucent_scene({tests::make_sphere(3)}, tests::make_grey_medium(4, 0.02f));
    const ErrorReport error = bake_preview(scene).error;
    EXPECT_GT(error.points_between_checked, 20u);
    EXPECT_LT(error.between.rms_relative, error.at_receivers.rms_relative + 0.02);
}

TEST(Between, TargetIsMissedWhereTheMeshIsTooCoarseForIt) {
    BakeOptions options;
    options.error = 0.1;
    options.threads = 2;
    const BakeResult result = tests::bake_scene(ball_over_floor(1), options);
    EXPECT_LE(result.error.at_receivers.rms_relative, 0.1);
    EXPECT_FALSE(result.accuracy->met);
    EXPECT_THAT(result.warnings,
                Contains(Field(&formats::Diagnostic::remedy, HasSubstr("more vertices"))));
}

// The luminance that the check takes for the file's is what the runtime interpolates, for a distant
// eye along the normal: terms that depend on the view are seen from there at each vertex.
TEST(Between, MixOfVerticesIsTheRuntimes) {
    auto medium = tests::make_grey_medium(4, 0.4f);
    medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.5f, 0, {}, {}};
    const auto scene = tests::make_ball_on_floor(medium);
    BakeOptions options = tests::small_bake();
    options.set(kPhaseTerms, 9);
    const BakeResult result = tests::bake_scene(scene, options);
    const formats::AssetView asset = result.asset.view();
    ASSERT_EQ(asset.primitives[0].terms, 9u);
    const auto layouts = layout_rows(scene, result.plan, result.knobs);
    const std::vector<TestLight> lights = make_test_lights(8, 2).value();
    const auto rays = RayScene::build(scene, 1);
    for (const CheckPoint& probe :
         draw_surface_probes(scene, *rays, {0, 1}, {12, 0, 0}, Context{})) {
        const RowLayout& layout = layouts[probe.material];
        const Luminance found = relight_point(asset, probe, layout, lights);
        const glm::vec3 eye = probe.body.position + 1e4f * probe.receiver.normal;
        for (std::size_t l = 0; l < lights.size(); ++l) {
            if (!lights[l].discs.empty()) {
                continue;  // the runtime clamps what truncated suns make negative
            }
            runtime::LightVector light{8, std::vector<float>(4 * lights[l].coarse.size())};
            for (std::size_t k = 0; k < lights[l].coarse.size(); ++k) {
                std::fill_n(light.rgba.begin() + static_cast<std::ptrdiff_t>(4 * k), 3,
                            lights[l].coarse[k]);
            }
            const auto vertices = runtime::shade_for_picture(asset, light, {eye.x, eye.y, eye.z},
                                                             formats::TermSet::baked, 1);
            double mixed = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                mixed += static_cast<double>(probe.weight[k] *
                                             formats::luminance(vertices[probe.vertex[k]]));
            }
            EXPECT_NEAR(found[l], mixed, 2e-3 * std::abs(mixed) + 1e-4) << lights[l].name;
        }
    }
}

}  // namespace
}  // namespace opaline::bake
