// Light of volumes: grids of radiance and of temperatures.

#include "formats/media/load_emission.h"
#include "formats/fill_grid.h"
#include "formats/media/load_volumes.h"
#include "formats/vdb/write_vdb.h"
#include "tests/formats/media/media_text.h"
#include "tests/formats/vdb/vdb_files.h"

namespace opaline::tests {
namespace {

using formats::Rgb;
using formats::Scene;
using formats::VolumeEntry;
using ::testing::HasSubstr;

TEST(BlackBody, HasTheLuminanceAndColourThatAreKnown) {
    const auto luminance = [](double kelvin) {
        return static_cast<double>(formats::luminance(formats::black_body_radiance(kelvin)));
    };
    // Platinum at its freezing point, by which the candela was once defined: 60 cd/cm^2.
    const Rgb platinum = formats::black_body_radiance(2041.4);
    EXPECT_NEAR(luminance(2041.4), 6.0e5, 0.03 * 6.0e5);
    EXPECT_GT(platinum.r, 2 * platinum.g);
    // White of 6500 K is that of the display, but for a slight green of daylight.
    const Rgb white = formats::black_body_radiance(6500);
    EXPECT_NEAR(white.r / white.g, 1, 0.06);
    EXPECT_NEAR(white.b / white.g, 1, 0.06);
    EXPECT_EQ(formats::black_body_radiance(0), Rgb{});
    EXPECT_EQ(formats::black_body_radiance(1000).b, 0) << "outside of the display's colours";
    EXPECT_LT(luminance(800), 1e-3 * luminance(1200));
}

class LoadEmission : public testing::Test {
  protected:
    LoadEmission() {
        const auto density = formats::fill_grid({0, 0, 0}, {3, 3, 3}, 0.5,
                                                [](glm::ivec3 v) { return v.x > 0 ? 1.0 : 0.0; });
        const auto heat =
            formats::fill_grid({0, 0, 0}, {3, 3, 3}, 0.5, [](glm::ivec3 v) { return 500.0 * v.y; });
        // At (10, 0, 0) beside it, voxels twice as large.
        auto flame = formats::fill_grid({2, 0, 0}, {3, 1, 1}, 1, [](glm::ivec3) { return 2.0; });
        const std::vector<formats::VdbOutputGrid> grids{
            {"density", &density}, {"heat", &heat}, {"flame", &flame}};
        EXPECT_TRUE(formats::write_vdb(folder_ / "fire.vdb", grids));
    }
    VolumeEntry entry(const char* file = "fire.vdb") const {
        VolumeEntry e;
        e.where = "volumes > 0";
        e.file = folder_ / file;
        e.density = "density";
        e.sigma_t = {1, 2, 4};
        e.albedo = {0.5f, 0.75f, 1};
        return e;
    }
    static formats::Result<std::vector<formats::Diagnostic>> load(const VolumeEntry& e,
                                                                  Scene& scene) {
        formats::MediaFile media;
        media.volumes = {e};
        return formats::load_volumes(media, 1, scene, {.reader = OPALINE_VDB_READER});
    }
    static std::string fault(const VolumeEntry& e) {
        Scene scene;
        const auto loaded = load(e, scene);
        return loaded ? "" : loaded.error().diagnostics.front().fault;
    }
    const TemporaryFolder folder_;
};

TEST_F(LoadEmission, TemperaturesGlowByWhatTheyAbsorb) {
    VolumeEntry e = entry();
    e.temperature = "heat";
    e.temperature_scale = 2;
    e.emission_scale = 0.25;
    Scene scene;
    ASSERT_TRUE(load(e, scene));
    const formats::Volume& volume = scene.volumes.at(0);
    EXPECT_EQ(volume.emitter, "fire");
    EXPECT_EQ(volume.emission.table.size(), volume.density.table.size());
    EXPECT_EQ(volume.emission.at({0, 3, 1}), glm::vec3(0)) << "no density";
    const Rgb hot = formats::black_body_radiance(3000);
    const glm::vec3 found = volume.emission.at({2, 3, 1});
    EXPECT_NEAR(found.x, 0.25f * 1 * 0.5f * hot.r, 1e-3f * found.x);
    EXPECT_NEAR(found.y, 0.25f * 2 * 0.25f * hot.g, 1e-3f * found.y);
    EXPECT_EQ(found.z, 0) << "blue is not absorbed";
}

TEST_F(LoadEmission, RadianceOfOtherVoxelsIsSampledAtThoseOfTheDensity) {
    VolumeEntry e = entry();
    e.emission = "flame";
    e.emission_scale = 3;
    Scene scene;
    const auto loaded = load(e, scene);
    ASSERT_TRUE(loaded);
    EXPECT_TRUE(loaded->empty()) << "coarser voxels lose nothing";
    const formats::Volume& volume = scene.volumes.at(0);
    // Voxel 5 of half a metre is at 2.5 m, between voxels 2 and 3 of a metre.
    EXPECT_EQ(volume.emission.at({5, 1, 1}), glm::vec3(6));
    EXPECT_EQ(volume.emission.at({3, 1, 1}), glm::vec3(3)) << "halfway to where nothing is";
    EXPECT_EQ(volume.emission.at({1, 1, 1}), glm::vec3(0));
    EXPECT_EQ(volume.density.at({2, 1, 1}), 1) << "the density stays where it was";
    EXPECT_EQ(volume.density.extent, volume.emission.extent);
    EXPECT_EQ(volume.density.first_brick, volume.emission.first_brick);
}

TEST_F(LoadEmission, ColoursAreThoseOfTheGridAndDetailsThatAreLostAreNamed) {
    FileGrid density, color;
    density.voxels = box_of_voxels({0, 0, 0}, {4, 4, 4});
    color.name = "flame";
    color.values = Values::color;
    color.voxels = {{{4, 4, 4}, {1, 2, 3}}};
    color.transform = glm::dmat4(0.5);
    color.transform[3][3] = 1;
    write_file(folder_ / "color.vdb", {density, color});
    VolumeEntry e = entry("color.vdb");
    e.emission = "flame";
    Scene scene;
    const auto loaded = load(e, scene);
    ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
    ASSERT_EQ(loaded->size(), 1u);
    EXPECT_THAT(loaded->front().fault, HasSubstr("finer"));
    EXPECT_EQ(scene.volumes.at(0).emission.at({2, 2, 2}), glm::vec3(1, 2, 3));
}

TEST_F(LoadEmission, WhatCannotGlowIsRefusedOrNamed) {
    VolumeEntry e = entry();
    e.temperature = "fever";
    EXPECT_THAT(fault(e), HasSubstr("no grid 'fever'"));
    e.temperature = "heat";
    e.temperature_scale = 1e3;
    EXPECT_THAT(fault(e), HasSubstr("hotter than 100000 K"));
    e = entry();
    e.emission = "flame";
    e.emission_scale = 1e15;
    EXPECT_THAT(fault(e), HasSubstr("more than 1e15"));
    // Too cold to be seen: no emitter, and a warning.
    e = entry();
    e.temperature = "heat";
    e.temperature_scale = 1e-3;
    Scene scene;
    const auto cold = load(e, scene);
    ASSERT_TRUE(cold);
    ASSERT_EQ(cold->size(), 1u);
    EXPECT_THAT(cold->front().fault, HasSubstr("nothing of it"));
    EXPECT_TRUE(scene.volumes.at(0).emission.empty());
}

TEST_F(LoadEmission, GridsOfOtherKindsAreRefusedByTheirName) {
    FileGrid density, other;
    density.voxels = box_of_voxels({0, 0, 0}, {4, 4, 4});
    other.name = "flame";
    other.voxels = box_of_voxels({0, 0, 0}, {4, 4, 4});
    const auto refused = [&](const FileGrid& grid, bool is_heat = false) {
        write_file(folder_ / "other.vdb", {density, grid});
        VolumeEntry e = entry("other.vdb");
        (is_heat ? e.temperature : e.emission) = "flame";
        return fault(e);
    };
    FileGrid bad = other;
    bad.background = 300;
    EXPECT_THAT(refused(bad, true), HasSubstr("background")) << "what no grid may have";
    bad = other;
    bad.values = Values::color;
    EXPECT_THAT(refused(bad, true), HasSubstr("colours, not temperatures"));
    // A few huge voxels would be sampled a billion times.
    bad = other;
    bad.transform = glm::dmat4(1000);
    bad.transform[3][3] = 1;
    EXPECT_THAT(refused(bad), HasSubstr("too many voxels"));
    EXPECT_EQ(refused(bad, true), "") << "where there is density alone";
}

}  // namespace
}  // namespace opaline::tests
