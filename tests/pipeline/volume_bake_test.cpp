#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "bake/effects/volumes/volume_knobs.h"
#include "formats/media/fill_body.h"
#include "formats/media/split_absorption.h"
#include "formats/opal/cubemap.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"
#include "tests/support/media_bake.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;

Scene make_cloud() {
    Scene scene;
    scene.materials.resize(1);
    scene.volumes.push_back(make_volume(make_blob(0.5, 0.25), 4, 0.9f, 0.3f));
    return scene;
}

TEST(VolumeBake, FileStatesItsErrorByDirectionClass) {
    const bake::BakeResult result = bake_scene(make_cloud(), small_bake());
    ASSERT_TRUE(result.volume_error.has_value());
    EXPECT_TRUE(result.error.not_measured.empty());
    const auto json = nlohmann::json::parse(result.asset.provenance);
    const auto& stated = json.at("volume_error");
    EXPECT_EQ(stated.at("rms_relative"), result.volume_error->rms_relative);
    EXPECT_GT(stated.at("rms_relative"), 0);
    EXPECT_EQ(stated.at("rays_checked"), 128);
    EXPECT_EQ(stated.at("by_light").size(), 4u);
    for (const char* name : {"forward", "side", "back", "even"}) {
        EXPECT_TRUE(stated.at("by_light").contains(name)) << name;
    }
}

TEST(VolumeBake, AVolumeThatOnlyAbsorbsHasNoErrorToMeasure) {
    Scene scene = make_cloud();
    scene.volumes[0].albedo = {0, 0, 0};
    EXPECT_FALSE(bake_scene(scene, small_bake()).volume_error.has_value());
}

bake::VolumeErrorReport bake_two_albedos(glm::vec3 below, glm::vec3 above,
                                         bake::VolumeMethod method) {
    Scene scene = make_cloud();
    vary_albedo(scene.volumes[0], [&](glm::dvec3 p) { return p.y > 0 ? above : below; });
    scene.volumes.push_back(*formats::split_absorption(scene.volumes[0]));
    bake::BakeOptions options = small_bake();
    options.set(bake::kVolumeSpacing, 2);
    options.set(bake::kVolumeMethod, static_cast<double>(method));
    return *bake_scene(scene, options).volume_error;
}

// Against path tracing, by both ways to light that was scattered before.
TEST(VolumeBake, AlbedosThatDifferFromPlaceToPlaceErrAsOneDoes) {
    const auto walks =
        bake_two_albedos({0.9f, 0.7f, 0.5f}, glm::vec3(0.1f), bake::VolumeMethod::walks);
    EXPECT_LT(walks.rms_relative, 0.09);
    const auto paths =
        bake_two_albedos(glm::vec3(0.9f), glm::vec3(0.1f), bake::VolumeMethod::path_integration);
    EXPECT_LT(paths.rms_relative, 0.25);
}

// What is seen of a file along lines beside each other, under even light and a sun.
std::vector<float> see_lines(const bake::BakeResult& result) {
    const formats::VolumesView volumes = result.asset.view().volumes;
    const std::uint32_t n = volumes.rows.cubemap_size;
    std::vector<formats::Rgb> sky(formats::cubemap_texels(n), {0.2f, 0.2f, 0.2f});
    sky[formats::texel_index(n, {0.6f, 0.8f, 0})] = {20, 20, 20};
    const runtime::VolumeLight lit =
        runtime::relight_volumes(volumes, runtime::project_cubemap(sky, n));
    const runtime::LitVolumes ready = runtime::light_volumes(volumes, lit);
    std::vector<float> seen;
    for (const float x : {-0.4f, -0.3f, 0.0f, 0.2f, 0.35f}) {
        const auto one = runtime::march_volumes(ready, {{x, 0.1f, -4}, {0, 0, 1}});
        seen.push_back(one.radiance.g);
        seen.push_back(one.transmittance.g);
    }
    return seen;
}

TEST(VolumeBake, AMeshedBallIsLitAsTheSameBallOfAGridIs) {
    Scene meshed = make_scene({make_sphere(4, 0.5f)});
    formats::Medium& medium = meshed.materials[0].medium.emplace();
    medium.sigma_s = {3.6f, 3.6f, 3.6f};
    medium.sigma_a = {0.4f, 0.4f, 0.4f};
    meshed.volumes.push_back(formats::fill_body(meshed, "Grey", 16, "", "")->volume);
    formats::remove_surface(meshed, "Grey");
    Scene grid;
    grid.materials.resize(1);
    grid.volumes.push_back(make_volume(make_ball_grid(0.5, 1.0 / 16), 4, 0.9f, 0));
    bake::BakeOptions options = small_bake();
    options.set(bake::kVolumeSpacing, 4);
    const bake::BakeResult result = bake_scene(meshed, options);
    ASSERT_EQ(result.asset.primitives.size(), 1u);
    EXPECT_EQ(result.asset.primitives[0].vertex_count, 0u);
    const std::vector<float> a = see_lines(result), b = see_lines(bake_scene(grid, options));
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(a[i], b[i], 0.015f) << i;
    }
}

// A dense core in thin smoke is baked in parts, with fewer nodes than the whole with the
// distance of the core's.
TEST(VolumeBake, PartsLookLikeTheWholeAlsoWhereTheyMeet) {
    Scene scene;
    scene.materials.resize(1);
    scene.volumes.push_back(make_volume(sample_grid(glm::dvec3(2.1), 0.1,
                                                    [](glm::dvec3 p) {
                                                        const double r = glm::length(p);
                                                        return r > 1.6 ? 0.0 : r < 0.7 ? 1.0 : 0.01;
                                                    }),
                                        4, 0.9f, 0));
    const bake::BakeResult parted = bake_scene(scene, small_bake());
    bake::BakeOptions options = small_bake();
    options.set(bake::kVolumeSpacing, 2);
    const bake::BakeResult whole = bake_scene(scene, options);
    const auto &parts = parted.asset.volumes.records, &one = whole.asset.volumes.records;
    ASSERT_GT(parts.size(), 1u);
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(parts.front().spacing, 2u);
    EXPECT_EQ(parts.back().spacing, 8u);
    std::uint32_t nodes = 0;
    for (const formats::VolumeRecord& part : parts) {
        nodes += part.node_count;
    }
    EXPECT_LT(nodes, one[0].node_count / 2);
    EXPECT_EQ(parted.plan.size(), whole.plan.size());
    const std::vector<float> a = see_lines(parted), b = see_lines(whole);
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(a[i], b[i], i % 2 == 1 ? 1e-3f : 0.06f * b[i]) << i;
    }
}

// Voxels of two mean free paths, more than a draft has points for: their light is known between
// joined ones. A fifth is lost, since nodes of these lie four mean free paths apart.
TEST(VolumeBake, ADenseBallOfManyVoxelsThatAbsorbsNothingShowsMostOfTheSkyAtDraft) {
    Scene scene;
    scene.materials.resize(1);
    scene.volumes.push_back(make_volume(make_ball_grid(1, 1.0 / 14), 28, 1, 0));
    bake::BakeOptions options = small_bake();
    options.quality = bake::Quality::draft;
    const bake::BakeResult result = bake_scene(scene, options);
    const formats::AssetView view = result.asset.view();
    ASSERT_EQ(view.volumes.records.size(), 1u);
    EXPECT_LT(view.volumes.records[0].node_count, 8000u);
    const runtime::VolumeLight lit =
        runtime::relight_volumes(view.volumes, make_light("white", view.cubemap_size), {});
    for (const float aside : {0.0f, 0.4f, 0.7f}) {
        const runtime::MarchResult seen = runtime::march_volumes(
            runtime::light_volumes(view.volumes, lit), {{-4, aside, 0.1f}, {1, 0, 0}});
        EXPECT_NEAR(seen.radiance.g + seen.transmittance.g, 0.87, 0.17) << aside;
    }
}

TEST(VolumeBake, TargetWithinReachIsMetByTheCheapestQualityThatReachesIt) {
    bake::BakeOptions options = small_bake();
    options.error = 0.9;
    const bake::BakeResult easy = bake_scene(make_cloud(), options);
    ASSERT_EQ(easy.volume_trials.size(), 1u);
    EXPECT_EQ(easy.volume_trials[0].quality, bake::Quality::draft);
    EXPECT_LE(easy.volume_error->rms_relative, 0.9);
    EXPECT_EQ(easy.knobs[bake::kVolumeWalks], bake::kVolumeWalks.preset[0]);

    options.error = 0.9 * easy.volume_error->rms_relative;
    const bake::BakeResult harder = bake_scene(make_cloud(), options);
    EXPECT_GT(harder.volume_trials.size(), 1u);
    EXPECT_LT(harder.volume_error->rms_relative, easy.volume_error->rms_relative);
    EXPECT_GT(harder.knobs[bake::kVolumeWalks], bake::kVolumeWalks.preset[0]);
}

// The knobs of volumes are given: no quality differs enough from another.
TEST(VolumeBake, TargetOutOfReachIsMissedWithAWarningThatStatesTheError) {
    bake::BakeOptions options = small_bake();
    options.error = 0.001;
    options.set(bake::kVolumeSpacing, 4);
    options.set(bake::kVolumeWalks, 4);
    options.set(bake::kVolumeCoefficients, 32);
    options.set(bake::kVolumeTerms, 1);
    const bake::BakeResult result = bake_scene(make_cloud(), options);
    EXPECT_EQ(result.volume_trials.size(), 2u);
    EXPECT_GT(result.volume_error->rms_relative, 0.001);
    std::vector<std::string> texts;
    for (const formats::Diagnostic& warning : result.warnings) {
        texts.push_back(warning.fault);
    }
    EXPECT_THAT(texts, ::testing::Contains(HasSubstr("volumes err by")));
    EXPECT_EQ(result.knobs[bake::kVolumeWalks], 4);
}

TEST(VolumeBake, MethodThatWasAskedForIsTakenAndStated) {
    bake::BakeOptions options = small_bake();
    options.set(bake::kVolumeSpacing, 4);
    const bake::BakeResult walks = bake_scene(make_cloud(), options);
    options.set(bake::kVolumeMethod, static_cast<double>(bake::VolumeMethod::path_integration));
    const bake::BakeResult paths = bake_scene(make_cloud(), options);
    EXPECT_NE(paths.asset.volumes.rows.code8, walks.asset.volumes.rows.code8);
    const auto json = nlohmann::json::parse(paths.asset.provenance);
    EXPECT_EQ(json.at("knobs").at("volume_method"), "path-integration");
    EXPECT_THAT(json.at("plan").at(1).at("reason").get<std::string>(),
                HasSubstr("path integration, as --volume-method says"));
    EXPECT_THAT(walks.plan.at(1).reason, HasSubstr("random walks"));
}

}  // namespace
}  // namespace opaline::tests
