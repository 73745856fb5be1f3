#include "bake/refine/simplify_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/shared_rows.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using formats::Scene;

SimplifiedScene simplify(const Scene& scene, double error, unsigned threads = 2) {
    Context context;
    context.threads = threads;
    const RayScene rays = RayScene::build(scene, 2).value();
    SimplifyLimits limits;
    limits.error = error;
    limits.angle = 0.1;
    return simplify_scene(scene, rays, {}, limits, context);
}

// Relative RMS of what mixed vertices interpolate, over vertices and the cells of a cube map
// (suns), and under an even sky, against rows of their own.
struct FoundError {
    double suns = 0, sky = 0;
};
FoundError error_of(const Scene& scene, const formats::Slots& slots) {
    constexpr std::uint32_t kSize = 8, kCells = 6 * kSize * kSize;
    const RayScene rays = RayScene::build(scene, 2).value();
    const DirectionSet directions = make_direction_set(kSize);
    const std::vector<double> area = formats::texel_solid_angles(kSize);
    std::vector<std::vector<float>> rows;
    for (const Receiver& receiver : make_vertex_receivers(scene)) {
        gather_irradiance(rays, directions, receiver, rows.emplace_back(kCells));
    }
    double suns = 0, sky = 0, all_suns = 0, all_sky = 0;
    for (std::uint32_t v = 0; v < rows.size(); ++v) {
        if (!slots.view().is_mixed(v)) continue;
        double sum = 0, whole = 0;
        for (std::size_t j = 0; j < kCells; ++j) {
            const double cell = area[j % area.size()];
            auto e = static_cast<double>(rows[v][j]);
            whole += cell * e;
            all_suns += cell * e * e;
            for (std::size_t k = 0; k < 3; ++k) {
                e -= slots.mix[v].weight[k] / 255.0 *
                     static_cast<double>(rows[slots.vertex[slots.mix[v].slot[k]]][j]);
            }
            sum += cell * e;
            suns += cell * e * e;
        }
        sky += sum * sum;
        all_sky += whole * whole;
    }
    return {std::sqrt(suns / all_suns), std::sqrt(sky / all_sky)};
}

TEST(SimplifyScene, ADenseSphereKeepsItsLightUnderSunsAndAnEvenSky) {
    const Scene scene = tests::make_scene({tests::make_sphere(5)});
    for (const double error : {0.03, 0.01}) {
        const SimplifiedScene found = simplify(scene, error);
        ASSERT_FALSE(found.slots.mix.empty()) << error;
        EXPECT_EQ(found.report.given, 10242u);
        EXPECT_EQ(found.report.kept, found.slots.vertex.size());
        EXPECT_LT(found.report.kept, 3000u);
        EXPECT_LE(found.report.error, error);
        const FoundError by_rows = error_of(scene, found.slots);
        EXPECT_LT(by_rows.suns, 1.42 * error);  // half of the mean square is theirs
        EXPECT_LT(by_rows.sky, error);
    }
}

// A ball over a floor of 10,000 vertices.
Scene ball_over_dense_floor() {
    return tests::make_scene({tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 100),
                              tests::make_sphere(3, 0.3f, {0.31f, 0.31f, 0.2f})});
}

TEST(SimplifyScene, RowsStayWhereAShadowIsSharp) {
    const Scene scene = ball_over_dense_floor();
    const SimplifiedScene found = simplify(scene, 0.01);
    ASSERT_FALSE(found.slots.mix.empty());
    EXPECT_LT(found.report.kept, 7000u);
    // Of vertices of the floor by the ball, and of those inside its borders but far from
    // it.
    std::size_t near = 0, kept_near = 0, far = 0, kept_far = 0;
    const formats::Primitive& floor = scene.primitives[0];
    for (std::uint32_t v = 0; v < floor.position.size(); ++v) {
        const glm::vec3 x = floor.position[v];
        const float d = glm::distance(x, glm::vec3(0.31f, 0, 0.2f));
        const bool is_kept = !found.slots.view().is_mixed(v);
        if (d < 0.25f) {
            ++near;
            kept_near += is_kept ? 1 : 0;
        } else if (d > 1 && std::max(std::abs(x.x), std::abs(x.z)) < 1.9f) {
            ++far;
            kept_far += is_kept ? 1 : 0;
        }
    }
    EXPECT_GT(static_cast<double>(kept_near), 0.9 * static_cast<double>(near));
    EXPECT_LT(static_cast<double>(kept_far), 0.6 * static_cast<double>(far));
    const FoundError by_rows = error_of(scene, found.slots);
    EXPECT_LT(by_rows.suns, 0.02);
    EXPECT_LT(by_rows.sky, 0.01);
}

TEST(SimplifyScene, MediaThinWallsMetalsAndFewVerticesKeepTheirRows) {
    Scene scene = tests::make_scene({tests::make_sphere(4)});
    ASSERT_FALSE(simplify(scene, 0.03).slots.mix.empty());
    scene.materials[0].gloss = {.metallic = 1, .roughness = 0.3f};
    EXPECT_TRUE(simplify(scene, 0.03).slots.empty());
    scene.materials[0].gloss = {};
    scene.materials[0].sheet = formats::Sheet{};
    EXPECT_TRUE(simplify(scene, 0.03).slots.empty());
    scene.materials[0].sheet.reset();
    scene.materials[0].medium = tests::make_grey_medium(20, 0.05f);
    EXPECT_TRUE(simplify(scene, 0.03).slots.empty());
    EXPECT_TRUE(simplify(tests::make_scene({tests::make_sphere(2)}), 0.03).slots.empty());
}

// An unwelded copy has as many rows, and its vertices the mixes of the welded one's.
TEST(SimplifyScene, VerticesOfOnePlaceAndNormalAreMixedAlike) {
    const Scene welded = tests::make_scene({tests::make_sphere(4)});
    Scene apart = welded;
    formats::Primitive& p = apart.primitives[0];
    const formats::Primitive whole = std::exchange(p, {});
    for (const std::uint32_t corner : whole.index) {
        p.index.push_back(static_cast<std::uint32_t>(p.position.size()));
        p.position.push_back(whole.position[corner]);
        p.normal.push_back(whole.normal[corner]);
    }
    const SimplifiedScene found = simplify(apart, 0.03);
    ASSERT_FALSE(found.slots.mix.empty());
    EXPECT_EQ(found.report.given, whole.position.size());
    EXPECT_NEAR(static_cast<double>(found.report.kept),
                static_cast<double>(simplify(welded, 0.03).report.kept),
                0.1 * static_cast<double>(found.report.kept));
    const formats::Slots places = find_slots(apart);
    EXPECT_EQ(found.slots.place, places.slot);
    for (std::uint32_t v = 0; v < found.slots.slot.size(); ++v) {
        ASSERT_EQ(found.slots.slot[v], found.slots.slot[places.vertex[places.slot[v]]]);
    }
}

TEST(SimplifyScene, ResultIsTheSameForAnyNumberOfThreads) {
    const SimplifiedScene one = simplify(ball_over_dense_floor(), 0.02, 1);
    const SimplifiedScene five = simplify(ball_over_dense_floor(), 0.02, 5);
    ASSERT_FALSE(one.slots.mix.empty());
    EXPECT_EQ(one.slots.vertex, five.slots.vertex);
    EXPECT_EQ(one.report.error, five.report.error);
    EXPECT_TRUE(std::ranges::equal(one.slots.mix, five.slots.mix, [](const auto& a, const auto& b) {
        return std::ranges::equal(a.slot, b.slot) && std::ranges::equal(a.weight, b.weight);
    }));
}

}  // namespace
}  // namespace opaline::bake
