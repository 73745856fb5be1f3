// Light that surfaces send to volumes, in files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "bake/check/volumes/volume_error.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"
#include "tests/support/media_bake.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

using formats::Rgb;

// A wide floor below a ball of smoke about the origin.
Scene make_smoky_floor(Rgb floor, float sigma_t, float albedo, float g = 0, float height = 1.6f) {
    Scene scene = make_scene({make_quad({-30, -height, -30}, {0, 0, 60}, {60, 0, 0}, 12)});
    scene.materials[0].base_color = floor;
    scene.volumes.push_back(make_volume(make_ball_grid(0.5, 1.0 / 8), sigma_t, albedo, g));
    return scene;
}

bake::BakeOptions seen_bake(bool sees_surfaces = true) {
    bake::BakeOptions options =
        only({"direct", "sheet", "multiple", "volume-single", "volume-multiple", "volume-surface"});
    options.quality = bake::Quality::preview;
    options.set(bake::kVolumeSpacing, 2);
    if (sees_surfaces) {
        options.effects.emplace_back("surface-volume");
    }
    return options;
}

runtime::MarchResult look(const bake::BakeResult& result, glm::vec3 from, glm::vec3 direction,
                          const char* light = "white") {
    const formats::AssetView asset = result.asset.view();
    const runtime::VolumeLight lit =
        runtime::relight_volumes(asset.volumes, make_light(light, asset.cubemap_size));
    return runtime::march_volumes(
        runtime::light_volumes(asset.volumes, lit),
        {{from.x, from.y, from.z}, {direction.x, direction.y, direction.z}});
}

// Of what the smoke takes from the light behind it, how much it gives back.
double given_back(const bake::BakeResult& result, glm::vec3 from, glm::vec3 direction) {
    const runtime::MarchResult seen = look(result, from, direction);
    return static_cast<double>(seen.radiance.g / (1 - seen.transmittance.g));
}

TEST(SeenSurfaces, SmokeThatAbsorbsNothingOverAWhiteFloorVanishesInEvenLight) {
    const Scene scene = make_smoky_floor({1, 1, 1}, 2, 1, 0.5f, 4);
    const bake::BakeResult lit = bake_scene(scene, seen_bake());
    const bake::BakeResult dark = bake_scene(scene, seen_bake(false));
    for (const glm::vec3 direction :
         {glm::vec3(1, 0, 0), glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(0.6f, 0, 0.8f)}) {
        EXPECT_NEAR(given_back(lit, -1.2f * direction, direction), 1, 0.07);
        EXPECT_LT(given_back(dark, -1.2f * direction, direction), 0.82);
    }
}

TEST(SeenSurfaces, GreySmokeOverARedFloorIsRed) {
    const bake::BakeResult over_red =
        bake_scene(make_smoky_floor({0.9f, 0.1f, 0.1f}, 2, 0.9f), seen_bake());
    EXPECT_EQ(over_red.asset.volumes.records.at(0).bands, 3u);
    const Rgb from_side = look(over_red, {-1.2f, 0, 0}, {1, 0, 0}).radiance;
    EXPECT_GT(from_side.r, 1.3f * from_side.b);
    EXPECT_NEAR(from_side.g, from_side.b, 1e-3f * from_side.g);
    const bake::BakeResult over_grey =
        bake_scene(make_smoky_floor({0.5f, 0.5f, 0.5f}, 2, 0.9f), seen_bake());
    EXPECT_EQ(over_grey.asset.volumes.records.at(0).bands, 1u);
}

// A leaf above, a body below and a floor that is dark behind: all kinds of surfaces.
Scene make_smoke_between() {
    Scene scene = make_smoky_floor({0.6f, 0.5f, 0.4f}, 3, 0.9f, 0.3f);
    Primitive leaf = make_quad({-0.8f, 0.8f, -0.8f}, {0, 0, 1.6f}, {1.6f, 0, 0}, 4);
    leaf.material = 1;
    Primitive body = make_sphere(3, 0.5f, {0.4f, -1.05f, 0});
    body.material = 2;
    scene.primitives.push_back(leaf);
    scene.primitives.push_back(body);
    scene.materials.resize(3);
    scene.materials[1].sheet = formats::Sheet{{0.3f, 0.3f, 0.3f}, {0.5f, 0.5f, 0.5f}};
    formats::Medium& wax = scene.materials[2].medium.emplace();
    wax.sigma_s = {200, 200, 200};
    wax.sigma_a = {0.2f, 0.2f, 0.2f};
    return scene;
}

TEST(SeenSurfaces, LightOfFloorLeafAndBodyInSmokeAgreesWithPathTracing) {
    const Scene scene = make_smoke_between();
    bake::VolumeCheckOptions options;
    options.max_events = 3000000;
    options.sees_surfaces = true;
    const auto check = [&](const bake::BakeResult& result) {
        return bake::check_volumes(scene, result.asset.view(), options, {}).value().by_light;
    };
    const auto lit = check(bake_scene(scene, seen_bake()));
    const auto dark = check(bake_scene(scene, seen_bake(false)));
    // Suns throw shadows of the leaf that nodes and eight texels cannot show: their means agree.
    for (std::size_t i = 0; i < lit.size(); ++i) {
        EXPECT_LT(std::abs(lit[i].bias), 0.12) << lit[i].name;
        EXPECT_LT(dark[i].bias, -0.25) << dark[i].name;
    }
    EXPECT_LT(lit.back().rms_relative, 0.1) << "under even light";
    EXPECT_GT(dark.back().rms_relative, 0.4);
}

TEST(SeenSurfaces, SmokeShowsNoMoreThanTheBoundAndAGoodPartOfIt) {
    for (const float sigma_t : {0.05f, 4.0f}) {
        const Scene scene = make_smoky_floor({0.7f, 0.7f, 0.7f}, sigma_t, 0.9f);
        bake::BakeOptions options = seen_bake();
        options.effects = {"direct", "surface-volume"};
        const bake::BakeResult result = bake_scene(scene, options);
        const auto entry = std::ranges::find_if(
            result.plan, [](const bake::PlanEntry& e) { return e.name == "surface-volume"; });
        ASSERT_NE(entry, result.plan.end());
        EXPECT_TRUE(entry->on);
        const double seen = look(result, {-1.2f, 0, 0}, {1, 0, 0}).radiance.g;
        EXPECT_LE(seen, entry->bound);
        EXPECT_GT(seen, 0.1 * entry->bound);
    }
}

TEST(SeenSurfaces, NothingIsSentByBlackOnesOrToSmokeTooThinToBeSeen) {
    const auto is_on = [](const Scene& scene) {
        return bake::sees_surfaces(
            bake::plan_volumes(scene, bake::resolve_knobs(seen_bake()).value()).entries);
    };
    EXPECT_TRUE(is_on(make_smoky_floor({0.5f, 0.5f, 0.5f}, 1, 0.9f)));
    EXPECT_FALSE(is_on(make_smoky_floor({0.5f, 0.5f, 0.5f}, 1e-3f, 0.9f)));
    EXPECT_FALSE(is_on(make_smoky_floor({0.5f, 0.5f, 0.5f}, 1, 0)));
    EXPECT_FALSE(is_on(make_smoky_floor({1e-3f, 1e-3f, 1e-3f}, 1, 0.9f)));
    Scene alone = make_smoky_floor({0.5f, 0.5f, 0.5f}, 1, 0.9f);
    alone.primitives.clear();
    EXPECT_FALSE(is_on(alone));
}

// A black cloud between the sun and a small floor, beside the way from the floor to the smoke.
TEST(SeenSurfaces, FloorInTheShadowOfAnotherVolumeSendsHardlyAnything) {
    Scene scene = make_smoky_floor({0.8f, 0.8f, 0.8f}, 2, 0.9f);
    scene.primitives[0] = make_quad({-0.2f, -1.6f, -0.2f}, {0, 0, 0.4f}, {0.4f, 0, 0}, 2);
    bake::BakeOptions options = seen_bake();
    options.effects = {"direct", "surface-volume"};
    const auto from_side = [&] {
        return look(bake_scene(scene, options), {0, 0, -1.2f}, {0, 0, 1}, "sun:90,30").radiance.g;
    };
    const float lit = from_side();
    EXPECT_GT(lit, 0);
    formats::Volume cloud = make_volume(make_ball_grid(0.5, 0.125), 20, 0, 0);
    cloud.density.to_scene[3] += glm::dvec4(1.3, -0.85, 0, 0);
    scene.volumes.push_back(cloud);
    EXPECT_LT(from_side(), 0.3f * lit);
}

// One that reflects and lets nothing through, with the sun on the side of its normal.
TEST(SeenSurfaces, SmokeSeesTheSideOfASheetThatFacesIt) {
    bake::BakeOptions options = seen_bake();
    options.effects = {"sheet", "surface-volume"};
    const auto from_side = [&](float height) {
        Scene scene = make_smoky_floor({1, 1, 1}, 2, 0.9f, 0, height);
        scene.materials[0].sheet = formats::Sheet{{0.8f, 0.8f, 0.8f}, {0, 0, 0}};
        return look(bake_scene(scene, options), {-1.2f, 0, 0}, {1, 0, 0}, "sun:90,60").radiance.g;
    };
    const float above = from_side(1.6f), below = from_side(-1.6f);
    EXPECT_GT(above, 0.01f);
    EXPECT_LT(below, 0.02f * above);
}

// What a roof shows below it is not the sun above it, but what reaches it from below.
TEST(SeenSurfaces, BacksOfDoubleSidedRoofsSendTheLightThatFallsOnThem) {
    Scene scene = make_smoky_floor({0.8f, 0.8f, 0.8f}, 2, 0.9f, 0, -0.8f);
    bake::BakeOptions options = seen_bake();
    options.quality = bake::Quality::draft;
    const bake::BakeResult single_sided = bake_scene(scene, options);
    scene.materials[0].double_sided = true;
    const bake::BakeResult double_sided = bake_scene(scene, options);
    const auto from_side = [](const bake::BakeResult& result, const char* light) {
        return look(result, {-1.2f, 0, 0}, {1, 0, 0}, light).radiance.g;
    };
    const float even = from_side(single_sided, "white");
    EXPECT_GT(from_side(double_sided, "white"), 1.1f * even);
    EXPECT_NEAR(from_side(double_sided, "sun:90,60"), from_side(single_sided, "sun:90,60"),
                0.02f * even);
}

// Paths know of the sky alone: what surfaces add is the same beside either way, and the sky counts
// once.
TEST(SeenSurfaces, BesidePathsWalksFindLightOfSurfacesAndNothingElse) {
    const Scene scene = make_smoky_floor({0.8f, 0.8f, 0.8f}, 3, 0.9f);
    const auto light = [&](bake::VolumeMethod method, bool sees_surfaces) {
        bake::BakeOptions options = seen_bake(sees_surfaces);
        options.quality = bake::Quality::production;  // which averages no rows of neighbours
        options.set(bake::kVolumeWalks, 192);
        options.set(bake::kVolumeMethod, static_cast<double>(method));
        return double{look(bake_scene(scene, options), {-1.2f, 0, 0}, {1, 0, 0}).radiance.g};
    };
    const double sky = light(bake::VolumeMethod::walks, false);
    const double sky_by_paths = light(bake::VolumeMethod::path_integration, false);
    const double added = light(bake::VolumeMethod::walks, true) - sky;
    EXPECT_GT(added, 0.1);
    EXPECT_NEAR(light(bake::VolumeMethod::path_integration, true) - sky_by_paths, added,
                0.03 * added);
    EXPECT_NEAR(sky_by_paths, sky, 0.15 * sky);
}

TEST(SeenSurfaces, ColouredMirrorsMakeColouredRowsAndGreyOnesDoNot) {
    Scene scene = make_smoky_floor({0.5f, 0.5f, 0.5f}, 1, 0.9f);
    const auto is_coloured = [&] {
        return bake::plan_volumes(scene, bake::resolve_knobs(seen_bake()).value())
            .layouts.at(0)
            .coloured;
    };
    scene.materials[0].gloss.specular_color = {25, 5, 5};
    EXPECT_FALSE(is_coloured()) << "mirrors nothing";
    scene.materials[0].gloss.specular = 1;
    EXPECT_TRUE(is_coloured());
}

TEST(SeenSurfaces, WalksAreNoIdleKnobWhereTheyFindLightOfSurfacesAlone) {
    const Scene scene = make_smoky_floor({0.5f, 0.5f, 0.5f}, 1, 0.9f, 0.5f);
    bake::BakeOptions options = seen_bake();
    options.effects = {"direct", "volume-single", "surface-volume"};
    const auto plan = bake::plan_volumes(scene, bake::resolve_knobs(options).value());
    EXPECT_TRUE(bake::kVolumeWalks.matters({}, plan.entries));
    EXPECT_TRUE(bake::kVolumeTerms.matters({}, plan.entries));
    EXPECT_FALSE(bake::kVolumePaths.matters({}, plan.entries));
    options.effects = {"direct", "volume-single"};
    const auto once = bake::plan_volumes(scene, bake::resolve_knobs(options).value());
    EXPECT_FALSE(bake::kVolumeWalks.matters({}, once.entries));
}

// What volumes send back to surfaces of what these had sent to them.
TEST(SeenSurfaces, FloorBelowSmokeMissesLessOfItsLight) {
    Scene scene = make_smoky_floor({0.9f, 0.9f, 0.9f}, 8, 1);
    scene.primitives[0] = make_quad({-1, -0.8f, -1}, {0, 0, 2}, {2, 0, 0}, 8);
    const bake::BakeResult result = bake_scene(scene, seen_bake());
    bake::ModelCheckOptions options;
    options.receivers = 64;
    options.max_events = 2000000;
    options.lit_by_volumes = true;
    const auto from_sky = bake::check_model(scene, result.asset.view(), options, {});
    options.volumes_see_surfaces = true;
    const auto from_both = bake::check_model(scene, result.asset.view(), options, {});
    ASSERT_TRUE(from_sky && from_both);
    EXPECT_LT(std::abs(from_both->bias), 0.03);
    EXPECT_LT(from_both->missing, 0.5 * from_sky->missing);
    EXPECT_GT(from_sky->bias, from_both->bias + 0.01);
}

}  // namespace
}  // namespace opaline::tests
