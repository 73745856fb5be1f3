#include "formats/media/load_volumes.h"

#include "formats/fill_grid.h"
#include "formats/vdb/write_vdb.h"
#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::ImportedScene;
using formats::MediaFile;
using formats::Result;
using formats::Scene;
using formats::SparseGrid;
using formats::VolumeEntry;
using ::testing::HasSubstr;

class LoadVolumes : public testing::Test {
  protected:
    // Voxels of half a unit; the value of each is its x, from 0 to 3.
    LoadVolumes() {
        const auto grid =
            formats::fill_grid({0, 0, 0}, {3, 3, 3}, 0.5, [](glm::ivec3 voxel) { return voxel.x; });
        write("smoke.vdb", {{"density", &grid}});
        write("two.vdb", {{"soot", &grid}, {"steam", &grid}});
        write("usual.vdb", {{"soot", &grid}, {"density", &grid}});
    }
    void write(const char* name, std::vector<formats::VdbOutputGrid> grids) {
        ASSERT_TRUE(formats::write_vdb(folder_ / name, grids));
    }
    VolumeEntry entry(const char* name) const {
        VolumeEntry e;
        e.where = "volumes > 0";
        e.file = folder_ / name;
        return e;
    }
    static MediaFile media(std::vector<VolumeEntry> entries) {
        MediaFile file;
        file.file = "media.json";
        file.volumes = std::move(entries);
        return file;
    }
    static std::string fault(const formats::Error& error) {
        return error.diagnostics.front().fault;
    }
    const TemporaryFolder folder_;
};

const formats::VdbReadOptions kReader{.reader = OPALINE_VDB_READER};

Result<std::vector<formats::Diagnostic>> load(const MediaFile& media, double unit, Scene& scene) {
    return formats::load_volumes(media, unit, scene, kReader);
}

Result<ImportedScene> import(const std::filesystem::path& path, const MediaFile& media) {
    return formats::import_vdb(path, media, 1, kReader);
}

glm::dvec3 place(const Scene& scene, glm::dvec3 index) {
    return scene.origin + glm::dvec3(scene.volumes.front().density.to_scene * glm::dvec4(index, 1));
}

TEST_F(LoadVolumes, PlacesVoxelsByTheFilesTransformTheEntrysAndTheUnit) {
    VolumeEntry e = entry("smoke.vdb");
    e.transform[3] = glm::dvec4(10, 0, 0, 1);
    e.transform[1][1] = 3;
    e.scale = 2;
    Scene scene;
    ASSERT_TRUE(load(media({e}), 0.01, scene));
    ASSERT_EQ(scene.volumes.size(), 1u);
    EXPECT_EQ(scene.volumes[0].density.at({3, 1, 2}), 6.0f);
    const glm::dvec3 at = place(scene, {2, 2, 2});
    EXPECT_NEAR(at.x, 0.11, 1e-12);
    EXPECT_NEAR(at.y, 0.03, 1e-12);
    EXPECT_NEAR(at.z, 0.01, 1e-12);
}

TEST_F(LoadVolumes, FarFromTheWorldsOriginTheyHaveAnOriginOfTheirOwn) {
    VolumeEntry e = entry("smoke.vdb");
    e.transform[3] = glm::dvec4(1e6, 1, -1e6, 1);
    Scene scene;
    ASSERT_TRUE(load(media({e}), 1, scene));
    EXPECT_NEAR(scene.origin.x, 1e6, 10);
    EXPECT_EQ(scene.origin.y, 0);
    const glm::dvec3 at = place(scene, {2, 2, 2});
    EXPECT_NEAR(at.x, 1e6 + 1, 1e-6);
    EXPECT_NEAR(at.z, -1e6 + 1, 1e-6);
    // Beside meshes it is the scene's.
    Scene meshes;
    meshes.primitives.resize(1);
    meshes.origin = {5, 6, 7};
    ASSERT_TRUE(load(media({entry("smoke.vdb")}), 1, meshes));
    EXPECT_EQ(meshes.origin, glm::dvec3(5, 6, 7));
    EXPECT_NEAR(place(meshes, {2, 2, 2}).y, 1, 1e-12);
}

TEST_F(LoadVolumes, TheDensityIsTheGridNamedSoOrTheOnlyOne) {
    Scene scene;
    std::vector<std::string> notes;
    const auto usual =
        formats::load_volumes(media({entry("usual.vdb")}), 1, scene, kReader, &notes);
    ASSERT_TRUE(usual);
    EXPECT_EQ(usual->size(), 0u) << "other grids call for no warning";
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_THAT(notes[0], HasSubstr("not used: 'soot'"));
    const auto unclear = load(media({entry("two.vdb")}), 1, scene);
    ASSERT_FALSE(unclear);
    EXPECT_THAT(fault(unclear.error()), HasSubstr("'soot', 'steam'"));
    VolumeEntry named = entry("two.vdb");
    named.density = "steam";
    EXPECT_TRUE(load(media({named}), 1, scene));
    named.density = "fog";
    EXPECT_FALSE(load(media({named}), 1, scene));
    EXPECT_EQ(scene.volumes.size(), 2u) << "what failed added nothing";
}

TEST_F(LoadVolumes, WhatNoLightCouldCrossInAMillionStepsIsRefused) {
    VolumeEntry e = entry("smoke.vdb");
    Scene scene;
    e.sigma_t = {0, 6e5f, 0};  // times 3, times half a metre
    EXPECT_TRUE(load(media({e}), 1, scene));
    e.sigma_t = {0, 8e5f, 0};
    const auto dense = load(media({e}), 1, scene);
    ASSERT_FALSE(dense);
    EXPECT_THAT(fault(dense.error()), HasSubstr("million"));
    e = entry("smoke.vdb");
    const auto far = load(media({e}), 1e9, scene);
    ASSERT_FALSE(far);
    EXPECT_THAT(fault(far.error()), HasSubstr("1e9 m"));
    e.file = "";
    const auto nameless = load(media({e}), 1, scene);
    ASSERT_FALSE(nameless);
    EXPECT_THAT(fault(nameless.error()), HasSubstr("names no file"));
}

TEST_F(LoadVolumes, AVdbFileIsASceneWithADefaultMediumOrTheStatedOne) {
    const auto plain = import(folder_ / "smoke.vdb", media({}));
    ASSERT_TRUE(plain);
    ASSERT_EQ(plain->warnings.size(), 1u);
    EXPECT_THAT(plain->warnings[0].fault, HasSubstr("0.99"));
    ASSERT_EQ(plain->scene.volumes.size(), 1u);
    EXPECT_EQ(plain->scene.volumes[0].sigma_t, (formats::Rgb{1, 1, 1}));
    EXPECT_EQ(plain->scene.inputs.size(), 1u);
    EXPECT_EQ(plain->scene.sha256.size(), 64u);

    // By its name, or without one: the file is loaded once.
    for (const VolumeEntry& own : {entry("smoke.vdb"), VolumeEntry{}}) {
        VolumeEntry e = own;
        e.sigma_t = {2, 2, 2};
        const auto stated = import(folder_ / "smoke.vdb", media({e}));
        ASSERT_TRUE(stated);
        EXPECT_TRUE(stated->warnings.empty());
        ASSERT_EQ(stated->scene.volumes.size(), 1u);
        EXPECT_EQ(stated->scene.volumes[0].sigma_t.g, 2);
    }
    const auto both = import(folder_ / "smoke.vdb", media({entry("usual.vdb")}));
    ASSERT_TRUE(both);
    EXPECT_EQ(both->scene.volumes.size(), 2u);
    EXPECT_FALSE(import(folder_ / "nowhere.vdb", media({})));
}

}  // namespace
}  // namespace opaline::tests
