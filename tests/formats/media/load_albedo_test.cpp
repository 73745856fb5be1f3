// Albedos of volumes that a grid tells.
#include <cmath>

#include "formats/fill_grid.h"
#include "formats/media/load_emission.h"
#include "formats/media/load_volumes.h"
#include "formats/vdb/write_vdb.h"
#include "tests/formats/media/media_text.h"
#include "tests/formats/vdb/vdb_files.h"

namespace opaline::tests {
namespace {

using formats::Rgb;
using formats::Scene;
using formats::Volume;
using formats::VolumeEntry;
using ::testing::HasSubstr;

class LoadAlbedo : public testing::Test {
  protected:
    LoadAlbedo() {
        density_.voxels = box_of_voxels({0, 0, 0}, {4, 4, 4});
        albedo_.name = "albedo";
        albedo_.values = Values::color;
    }
    VolumeEntry entry() const {
        VolumeEntry e;
        e.where = "volumes > 0";
        e.file = folder_ / "smoke.vdb";
        e.density = "density";
        e.albedo_grid = "albedo";
        e.scale = 2;
        return e;
    }
    formats::Result<std::vector<formats::Diagnostic>> load(const VolumeEntry& e,
                                                           Scene& scene) const {
        write_file(folder_ / "smoke.vdb", {density_, albedo_});
        formats::MediaFile media;
        media.volumes = {e};
        return formats::load_volumes(media, 1, scene, {.reader = OPALINE_VDB_READER});
    }
    VolumeEntry plain_entry() const {
        VolumeEntry e = entry();
        e.albedo_grid.clear();
        return e;
    }
    Scene loaded_scene(const VolumeEntry& e) const {
        Scene scene;
        const auto result = load(e, scene);
        EXPECT_TRUE(result) << result.error().diagnostics.front().fault;
        return scene;
    }
    Volume loaded(const VolumeEntry& e) const { return loaded_scene(e).volumes.at(0); }
    std::string fault() const {
        Scene scene;
        const auto result = load(entry(), scene);
        return result ? "" : result.error().diagnostics.front().fault;
    }
    // All voxels of the density.
    void fill(glm::vec3 albedo) {
        albedo_.voxels.clear();
        for (const Voxel& voxel : density_.voxels) {
            albedo_.voxels.push_back({voxel.at, albedo});
        }
    }
    FileGrid density_, albedo_;
    const TemporaryFolder folder_;
};

TEST_F(LoadAlbedo, AVolumeThatScattersAndOneThatAbsorbsAreTogetherWhatEachVoxelDoes) {
    const glm::ivec3 a(1, 2, 3), b(2, 2, 2);
    albedo_.voxels = {{a, {0.25f, 0.5f, 0.8f}}, {b, {0.4f, 0.125f, 0.5f}}};
    const Scene scene = loaded_scene(entry());
    ASSERT_EQ(scene.volumes.size(), 2u);
    const Volume &scatters = scene.volumes[0], &absorbs = scene.volumes[1];
    EXPECT_EQ(absorbs.albedo, (Rgb{0, 0, 0}));
    const Volume plain = loaded(plain_entry());
    for (const Voxel& voxel : density_.voxels) {
        EXPECT_NEAR(scatters.density.at(voxel.at) + absorbs.density.at(voxel.at),
                    plain.density.at(voxel.at), 1e-6f);
    }
    for (const Voxel& voxel : albedo_.voxels) {
        const glm::vec3 found =
            scatters.density.at(voxel.at) * scatters.albedo_at(glm::vec3(voxel.at));
        EXPECT_LT(glm::length(found - plain.density.at(voxel.at) * voxel.value), 1e-6f);
    }
    EXPECT_EQ(scatters.density.at({0, 0, 0}), 0) << "no albedo: it absorbs";
    EXPECT_NEAR(absorbs.density.at(a), 0, 1e-6f) << "as bright as any";
    // Between voxels coefficients are linear, so that dense ones count for more, and places
    // without density do not.
    EXPECT_LT(glm::length(scatters.albedo_at({1, 2, 3.75f}) - scatters.albedo_at(a)), 1e-5f);
}

TEST_F(LoadAlbedo, AGreyGridLeavesOneAlbedo) {
    albedo_.values = Values::scalar;
    fill(glm::vec3(0.5f));
    albedo_.voxels[7].value = glm::vec3(0.9f);
    const Scene scene = loaded_scene(entry());
    ASSERT_EQ(scene.volumes.size(), 2u);
    EXPECT_NEAR(scene.volumes[0].albedo.g, 0.9f, 1e-5f);
    EXPECT_TRUE(scene.volumes[0].scattering.empty());
    // Hues alike, too: all of the colour is in the number.
    albedo_.values = Values::color;
    for (std::size_t i = 0; i < albedo_.voxels.size(); ++i) {
        albedo_.voxels[i].value =
            (0.1f + 0.01f * static_cast<float>(i)) * glm::vec3(1, 0.5f, 0.25f);
    }
    EXPECT_TRUE(loaded(entry()).scattering.empty());
}

TEST_F(LoadAlbedo, WhatAbsorbsCountsAsAVolume) {
    fill(glm::vec3(0.5f));
    albedo_.voxels[0].value = glm::vec3(1);
    write_file(folder_ / "smoke.vdb", {density_, albedo_});
    formats::MediaFile media;
    media.volumes.assign(9, entry());
    Scene scene;
    const auto result = formats::load_volumes(media, 1, scene, {.reader = OPALINE_VDB_READER});
    ASSERT_FALSE(result);
    EXPECT_THAT(result.error().diagnostics.front().fault, HasSubstr("more than 16"));
    EXPECT_TRUE(scene.volumes.empty());
}

TEST_F(LoadAlbedo, OneAlbedoAtAllVoxelsIsTheNumberThatAMediaFileWouldGive) {
    fill({0.5f, 0.25f, 1});
    albedo_.voxels.push_back({{20, 0, 0}, {1, 1, 1}});  // where no density is
    const Volume volume = loaded(entry());
    EXPECT_EQ(volume.albedo, (Rgb{0.5f, 0.25f, 1}));
    EXPECT_TRUE(volume.scattering.empty());
    albedo_.values = Values::scalar;
    fill(glm::vec3(1.0005f));
    EXPECT_EQ(loaded(entry()).albedo, (Rgb{1, 1, 1})) << "rounding is not more than all light";
}

TEST_F(LoadAlbedo, HeatGlowsByWhatEachVoxelAbsorbs) {
    FileGrid heat = density_;
    heat.name = "heat";
    for (Voxel& voxel : heat.voxels) {
        voxel.value = glm::vec3(2000);
    }
    fill({0.5f, 0.75f, 0});
    albedo_.voxels[0].value = glm::vec3(1);
    write_file(folder_ / "smoke.vdb", {density_, albedo_, heat});
    VolumeEntry e = entry();
    e.temperature = "heat";
    formats::MediaFile media;
    media.volumes = {e};
    Scene scene;
    ASSERT_TRUE(formats::load_volumes(media, 1, scene, {.reader = OPALINE_VDB_READER}));
    const Volume& volume = scene.volumes.at(0);
    const Rgb hot = formats::black_body_radiance(2000);
    const glm::vec3 found = volume.emission.at({2, 1, 2});
    const float density = volume.density.at({2, 1, 2}) + scene.volumes.at(1).density.at({2, 1, 2});
    EXPECT_NEAR(found.x, density * 0.5f * hot.r, 1e-3f * found.x);
    EXPECT_NEAR(found.y, density * 0.25f * hot.g, 1e-3f * found.y);
    EXPECT_EQ(volume.emission.at(density_.voxels[0].at), glm::vec3(0));
    EXPECT_EQ(volume.scattering.table, volume.density.table);
    EXPECT_TRUE(scene.volumes[1].emission.empty()) << "it glows once";
}

TEST_F(LoadAlbedo, OtherVoxelsAreSampledAtThoseOfTheDensity) {
    albedo_.values = Values::scalar;
    albedo_.transform = glm::dmat4(2);
    albedo_.transform[3][3] = 1;
    albedo_.voxels = {{{0, 0, 0}, glm::vec3(0.25f)}, {{1, 0, 0}, glm::vec3(0.75f)}};
    const Scene scene = loaded_scene(entry());
    EXPECT_NEAR(scene.volumes.at(0).albedo.g, 0.75f, 1e-6f);
    EXPECT_NEAR(scene.volumes[0].density.at({1, 0, 0}),
                2 * scene.volumes.at(1).density.at({1, 0, 0}), 1e-6f);
    EXPECT_EQ(scene.volumes[1].density.at({2, 0, 0}), 0);
    albedo_.transform = glm::dmat4(0.5);
    albedo_.transform[3][3] = 1;
    Scene other;
    const auto fine = load(entry(), other);
    ASSERT_TRUE(fine);
    ASSERT_EQ(fine->size(), 1u);
    EXPECT_THAT(fine->front().fault, HasSubstr("finer"));
}

TEST_F(LoadAlbedo, WhatIsNoAlbedoIsRefusedWithAMessage) {
    fill(glm::vec3(0.5f));
    EXPECT_EQ(fault(), "");
    albedo_.voxels[3].value.y = 1.01f;
    EXPECT_THAT(fault(), HasSubstr("albedos above 1"));
    albedo_.voxels[3].value.y = std::nanf("");
    EXPECT_THAT(fault(), HasSubstr("1 are NaN")) << "what no grid may hold";
    albedo_.voxels[3].value.y = 1;
    albedo_.name = "colour";
    EXPECT_THAT(fault(), HasSubstr("no grid 'albedo'"));
}

}  // namespace
}  // namespace opaline::tests
