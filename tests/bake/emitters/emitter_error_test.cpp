// The file's rows against paths that share nothing with them, and both against closed forms.
#include "bake/effects/emitters/emitter_error.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bake/effects/emitters/bake_emitters.h"
#include "bake/effects/emitters/emitter_knobs.h"
#include "tests/bake/emitters/bounced_lamps.h"

namespace opaline::bake {
namespace {

std::vector<formats::PrimitiveRecord> records_of(const formats::Scene& scene) {
    std::vector<formats::PrimitiveRecord> records(scene.primitives.size());
    for (std::size_t p = 0; p < records.size(); ++p) {
        records[p].vertex_count = static_cast<std::uint32_t>(scene.primitives[p].position.size());
    }
    return records;
}

formats::Scene lamp_in_a_box() {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(3, true), 0.6f);
    tests::add_surface(scene, tests::make_quad({-0.5f, 0.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}), 0.2f,
                       5);
    scene.primitives[1].name = "node 'Lamp' > mesh 0";
    scene.lights.push_back(
        {.name = "Bulb", .intensity = {1, 0.5f, 0.2f}, .position = {0.5f, -0.5f, 0}});
    return scene;
}

TEST(EmitterError, PathsReproduceTheFurnace) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(1, true), 0.5f, std::numbers::inv_pi_v<float>);
    const RayScene rays = tests::build_rays(scene);
    const auto receivers = tests::receivers_of(scene);
    const auto sources = tests::all_sources(scene);
    const auto records = records_of(scene);
    std::uint64_t traced = 0;
    const glm::dvec3 E = trace_irradiance({scene, rays, receivers, records, sources, {}},
                                          collect_true_sources(sources),
                                          {{0, 0.2f, 0.999f}, {0, 0, -1}}, 20000, 1, 2, traced);
    EXPECT_NEAR(E.x, 2, 0.05);
    EXPECT_GT(traced, 20000u);
}

TEST(EmitterError, BakedEmittersErrByAFewPercent) {
    const formats::Scene scene = lamp_in_a_box();
    const RayScene rays = tests::build_rays(scene);
    const auto receivers = tests::receivers_of(scene);
    const auto records = records_of(scene);
    const auto lamps = list_lamps(scene);
    Knobs knobs;
    knobs.set(kEmitterParticles, 100000);
    knobs.set(kEmitterRays, 256);
    StageLog log;
    const auto surfaces = tests::solve_surfaces(scene, rays, receivers);
    auto baked = bake_emitters({scene, rays, receivers, records, lamps, knobs, surfaces.get()},
                               Context{}, log);
    ASSERT_TRUE(baked);
    EXPECT_GE(baked->error.receivers_checked, 24u);
    EXPECT_LT(baked->error.rms_relative, 0.04);
    EXPECT_GT(baked->error.rms_relative, 1e-4) << "no less than what the check can resolve";
    const formats::EmittersView emitters = baked->emitters.view();
    EXPECT_EQ(formats::list_emitters(emitters), "'Lamp', 'Bulb'");
    ASSERT_EQ(emitters.own.size(), 1u);
    EXPECT_EQ(emitters.own[0].primitive, 1u);
    EXPECT_EQ(emitters.own[0].radiance, (formats::Rgb{5, 5, 5}));
    EXPECT_EQ(emitters.block.size(), 4u);
    EXPECT_EQ(log.size(), 4u);

    // An error that is put in is found.
    const auto sources = tests::all_sources(scene);
    for (formats::EmitterBlock& block : baked->emitters.block) {
        block.scale *= 1.1f;
    }
    std::uint64_t traced = 0;
    const EmitterErrorReport report = check_emitters(
        {scene, rays, receivers, records, sources, baked->emitters.view()}, 0, Context{}, traced);
    EXPECT_NEAR(report.rms_relative, 0.1, 0.02);
}

}  // namespace
}  // namespace opaline::bake
