// Light that volumes send out by themselves, as it is baked.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/effects/volumes/glow_walks.h"
#include "bake/effects/volumes/largest_light.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/plan/plan_input.h"
#include "formats/opal/half.h"
#include "runtime/volumes/volume_march.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

formats::Scene glowing_blob(glm::vec3 sigma_t, glm::vec3 albedo, float g, glm::vec3 own) {
    formats::Volume blob = tests::make_volume(tests::make_blob(0.5, 0.125), 1, 0, g);
    blob.sigma_t = {sigma_t.x, sigma_t.y, sigma_t.z};
    blob.albedo = {albedo.x, albedo.y, albedo.z};
    tests::make_it_glow(blob, own);
    return tests::scene_of(std::move(blob));
}

// At the middle of a blob that absorbs, light L_e (1 - exp(-depth)) comes from all directions.
TEST(GlowWalks, InTheMiddleOfABlobTheyFindWhatItsHalvesAbsorb) {
    const glm::vec3 sigma_t(0.5f, 2, 6), own(3, 2, 1);
    const formats::Scene scene = glowing_blob(sigma_t, glm::vec3(0), 0, own);
    const DensitySpace space = make_density_space(scene);
    const auto grids = make_glowing_grids(scene, {0});
    const RayScene sky = tests::empty_space();
    glm::vec3 found(0);
    gather_glow({space, grids, sky, 7}, {0, 0, glm::vec3(0), 20000, 1}, {&found, 1});
    const float column = 0.5f * std::sqrt(std::numbers::pi_v<float> / 2);
    const glm::vec3 truth =
        std::sqrt(4 * std::numbers::pi_v<float>) * own * (1.0f - glm::exp(-column * sigma_t));
    for (int band = 0; band < 3; ++band) {
        EXPECT_NEAR(found[band], truth[band], 0.02f * truth[band]) << band;
    }
}

TEST(GlowWalks, TheirLightIsScatteredTowardWhereItGoes) {
    // Beside the blob all its light comes from one side: it is scattered forward, away from it.
    const formats::Scene scene = glowing_blob(glm::vec3(2), glm::vec3(0.5f), 0.7f, glm::vec3(1));
    const DensitySpace space = make_density_space(scene);
    const auto grids = make_glowing_grids(scene, {0});
    const RayScene sky = tests::empty_space();
    std::array<glm::vec3, 4> found{};
    gather_glow({space, grids, sky, 7}, {0, 0, glm::vec3(1.5f, 0, 0), 4000, 4}, found);
    // Term 3 is x of the direction toward the eye, which the light goes on to.
    EXPECT_GT(found[3].x, 0.5f * found[0].x);
    EXPECT_NEAR(found[1].x, 0, 0.05f * found[0].x);
    EXPECT_NEAR(found[2].x, 0, 0.05f * found[0].x);
}

TEST(BakeGlow, RadianceIsKeptToAThousandthAndThereWhereNoDensityIs) {
    formats::Scene scene = glowing_blob({1, 1, 1}, glm::vec3(0), 0, {3, 2, 1});
    formats::Volume& volume = scene.volumes[0];
    for (float& value : volume.density.value) {
        value = value < 0.9f ? 0 : value;
    }
    const formats::Volumes volumes =
        tests::bake_volumes_of(scene, tests::small_knobs(Quality::preview, 4));
    const formats::VolumeRecord& record = volumes.records.at(0);
    ASSERT_EQ(volumes.glow.record.size(), 1u);
    const formats::GlowRecord& glow = volumes.glow.record[0];
    EXPECT_EQ(glow.terms, 0u) << "nothing is scattered";
    std::ptrdiff_t found = 0;
    tests::for_each_kept_voxel(
        volumes, record, [&](glm::ivec3 voxel, std::uint32_t brick, std::size_t i) {
            const auto at = std::ranges::find(volumes.glow.brick, brick);
            if (at == volumes.glow.brick.end()) return;
            const auto first = static_cast<std::size_t>(at - volumes.glow.brick.begin()) * 512;
            const glm::vec3 truth = volume.emission.at(voxel);
            const formats::Rgb kept =
                glow.code_scale * formats::unpack_shared(volumes.glow.code[first + i]);
            EXPECT_NEAR(kept.r, truth.x, 0.002f * truth.x + 1e-7f);
            EXPECT_NEAR(kept.b, truth.z, 0.002f * truth.x + 1e-7f);
            found += truth != glm::vec3(0) ? 1 : 0;
        });
    EXPECT_EQ(found, std::ranges::count_if(volume.emission.value,
                                           [](glm::vec3 v) { return v != glm::vec3(0); }));
}

TEST(PlanGlow, LightUnderTheBudgetIsLeftOutAndWhatIsLeftOutIsDarker) {
    const Knobs knobs = tests::small_knobs(Quality::preview, 8);
    for (const float own : {2e-4f, 1.0f}) {
        formats::Scene scene = glowing_blob(glm::vec3(0.3f), glm::vec3(0.5f), 0, glm::vec3(own));
        const VolumePlan plan = plan_volumes(scene, knobs);
        ASSERT_EQ(plan.entries.size(), 3u);
        const PlanEntry& entry = plan.entries[2];
        EXPECT_EQ(entry.name, "emitters");
        EXPECT_EQ(entry.on, own == 1.0f) << entry.reason;
        EXPECT_EQ(plan.layouts.at(0).glows, entry.on);
        EXPECT_EQ(plan.layouts[0].glow_terms, entry.on ? 1u : 0u);
        // Forced on, it adds no more than the bound along any ray.
        Knobs forced = knobs;
        forced.simulate_all = true;
        const formats::Volumes volumes = tests::bake_volumes_of(scene, forced);
        const runtime::VolumeLight lit =
            runtime::relight_volumes(volumes.view(), {}, {.terms = formats::TermSet::none});
        const runtime::LitVolumes ready = runtime::light_volumes(volumes.view(), lit);
        const float seen = runtime::march_volumes(ready, {{-4, 0, 0}, {1, 0, 0}}).radiance.g;
        EXPECT_GT(seen, 0);
        EXPECT_LT(static_cast<double>(seen), entry.bound);
    }
}

// The light that a bake with every effect shows along rays through the blob, with what it scatters
// of itself and without.
struct SeenGlow {
    double own = 0, scattered = 0;  // largest
};
SeenGlow look_at_glow(const formats::Scene& scene, Knobs knobs) {
    knobs.simulate_all = true;
    formats::Volumes volumes = tests::bake_volumes_of(scene, knobs);
    const auto look = [&](float off) {
        const runtime::VolumeLight lit =
            runtime::relight_volumes(volumes.view(), {}, {.terms = formats::TermSet::none});
        const runtime::LitVolumes ready = runtime::light_volumes(volumes.view(), lit);
        return static_cast<double>(
            runtime::march_volumes(ready, {{-4, off, 0}, {1, 0, 0}}).radiance.g);
    };
    constexpr float kPlaces[] = {0.0f, 0.3f, 0.6f, 0.9f};
    std::vector<double> all;
    for (const float off : kPlaces) {
        all.push_back(look(off));
    }
    volumes.glow.value.assign(volumes.glow.value.size(), 0);
    SeenGlow seen;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double own = look(kPlaces[i]);
        seen.own = std::max(seen.own, own);
        seen.scattered = std::max(seen.scattered, all[i] - own);
    }
    return seen;
}

// Of light E of its own a volume scatters at most s E / (1 - s), s its largest albedo times
// 1 - e^-tau. From below: what is left out is darker than the bound, which is below the budget.
// From above: what is kept is there, and no 60th of the bound.
TEST(PlanGlow, ScatteredLightOfItsOwnIsLeftOutByABoundThatHoldsAndIsNotVain) {
    const Knobs knobs = tests::small_knobs(Quality::preview, 8);
    for (const float depth : {0.05f, 0.3f, 2.0f}) {
        const auto make = [&](float own) {
            formats::Volume ball =
                tests::make_volume(tests::make_ball_grid(1, 0.125), depth, 0.9f, 0);
            tests::make_it_glow(ball, glm::vec3(own));
            return tests::scene_of(std::move(ball));
        };
        const auto bound_of = [](const formats::Scene& scene) {
            const double s = brightest(scene.volumes[0]).once;
            return largest_glow(scene.volumes[0]) * s / (1 - s);
        };
        // Just below and just above the budget.
        const auto limit = static_cast<float>(kLeastBound / bound_of(make(1)));
        const formats::Scene dark = make(0.98f * limit), bright = make(1.02f * limit);
        EXPECT_EQ(plan_volumes(dark, knobs).layouts.at(0).glow_terms, 0u) << depth;
        EXPECT_EQ(plan_volumes(bright, knobs).layouts.at(0).glow_terms, 1u) << depth;
        for (const formats::Scene& scene : {dark, bright}) {
            const SeenGlow seen = look_at_glow(scene, knobs);
            EXPECT_LE(seen.scattered, bound_of(scene)) << depth;
            EXPECT_GE(seen.scattered, bound_of(scene) / 60) << depth;
            EXPECT_LE(seen.own, largest_glow(scene.volumes[0])) << depth;
            EXPECT_LE(seen.own + seen.scattered, largest_scattered_glow(scene, scene.volumes[0]))
                << depth;
        }
    }
}

TEST(PlanGlow, WhatIsLeftOutByItsNameIsNotThere) {
    const formats::Scene scene = glowing_blob(glm::vec3(1), glm::vec3(0.5f), 0, glm::vec3(1));
    BakeOptions options;
    options.quality = Quality::draft;
    options.effects = {"volume-single"};
    const auto knobs = resolve_knobs(all_effects(), options);
    ASSERT_TRUE(knobs);
    const VolumePlan plan = plan_volumes(scene, *knobs);
    EXPECT_FALSE(plan.entries.at(2).on);
    EXPECT_EQ(plan.layouts.at(0).glow_terms, 0u);
    EXPECT_TRUE(tests::bake_volumes_of(scene, *knobs).glow.record.empty());
}

}  // namespace
}  // namespace opaline::bake
