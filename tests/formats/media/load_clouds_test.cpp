#include "formats/media/load_clouds.h"

#include "formats/image/exr.h"
#include "formats/media/apply_media.h"
#include "tests/formats/media/cloud_text.h"

namespace opaline::tests {
namespace {

using formats::MediaFile;
using formats::Scene;
using ::testing::HasSubstr;

MediaFile read_one(const std::string& entry) {
    const TemporaryFolder folder;
    auto media = read_cloud_in(folder, entry);
    EXPECT_TRUE(media) << faults(media);
    return media ? std::move(*media) : MediaFile{};
}

TEST(LoadClouds, AFormulaBecomesMetresOverTheWholeSize) {
    Scene scene;
    const MediaFile media = read_one(R"("thickness": 250, "size": [4000, 8000],
        "procedural": {"type": "cellular", "coverage": 0.6, "resolution": 64})");
    const auto warnings = formats::load_clouds(media, scene);
    ASSERT_TRUE(warnings);
    EXPECT_TRUE(warnings->empty());
    ASSERT_EQ(scene.layers.size(), 1u);
    const formats::CloudLayer& layer = scene.layers[0];
    EXPECT_EQ(layer.columns, 64u);
    EXPECT_EQ(layer.rows, 64u);
    ASSERT_EQ(layer.thickness.size(), 64u * 64u);
    EXPECT_FLOAT_EQ(*std::max_element(layer.thickness.begin(), layer.thickness.end()), 250);
    const auto empty = std::count(layer.thickness.begin(), layer.thickness.end(), 0.0f);
    EXPECT_NEAR(static_cast<double>(empty) / (64 * 64), 0.4, 0.02);
    formats::CloudEntry loaded;
    loaded.layer = layer;
    EXPECT_TRUE(is_sound(loaded));
}

TEST(LoadClouds, AFormulaThatEvolvesBecomesItsFrames) {
    Scene scene;
    ASSERT_TRUE(formats::load_clouds(
        read_one(R"("thickness": 250, "size": [4000, 4000], "procedural": {"type": "cellular",
            "resolution": 32, "evolution": {"period": 600, "frames": 5}})"),
        scene));
    ASSERT_EQ(scene.layers.size(), 1u);
    const formats::CloudLayer& layer = scene.layers[0];
    EXPECT_EQ(layer.frames, 5u);
    EXPECT_EQ(layer.frame_seconds, 120);
    EXPECT_TRUE(layer.loops);
    EXPECT_FLOAT_EQ(*std::max_element(layer.thickness.begin(), layer.thickness.end()), 250);
    formats::CloudEntry loaded;
    loaded.layer = layer;
    EXPECT_TRUE(is_sound(loaded));
}

// 16 frames of 4 million texels would take seconds.
TEST(LoadClouds, PlanOfAFormulaNeedsItsLargestThicknessAlone) {
    const MediaFile media = read_one(R"("thickness": 250, "procedural": {"type": "cellular",
        "coverage": 0.6, "resolution": 2048, "evolution": {"period": 3600}})");
    Scene scene;
    ASSERT_TRUE(formats::load_clouds(media, scene, formats::CloudDetail::largest));
    EXPECT_EQ(scene.layers[0].thickness, std::vector{250.0f});
    EXPECT_EQ(scene.layers[0].columns, 2048u);
    EXPECT_EQ(scene.layers[0].frames, 16u);
    Scene bare;
    const auto warnings =
        formats::load_clouds(read_one(R"("procedural": {"type": "waves", "coverage": 0})"), bare,
                             formats::CloudDetail::largest);
    ASSERT_TRUE(warnings);
    EXPECT_EQ(warnings->size(), 1u) << "of a layer that is not seen";
}

TEST(LoadClouds, AnEvenLayerStaysAsItIs) {
    Scene scene;
    ASSERT_TRUE(formats::load_clouds(read_one(R"("thickness": 42)"), scene));
    ASSERT_EQ(scene.layers.size(), 1u);
    EXPECT_THAT(scene.layers[0].thickness, ::testing::Each(42.0f));
}

TEST(LoadClouds, OneLayerIsAllThatASceneHas) {
    Scene scene;
    MediaFile media = read_one(R"("thickness": 42)");
    ASSERT_TRUE(formats::load_clouds(media, scene));
    media.file = "media.json";
    const auto second = formats::load_clouds(media, scene);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().diagnostics[0].file, "media.json");
    EXPECT_THAT(second.error().diagnostics[0].fault, HasSubstr("more than one cloud layer"));
    EXPECT_EQ(scene.layers.size(), 1u);
}

TEST(LoadClouds, NothingAtAllIsALayerWithAWarning) {
    Scene scene;
    const auto warnings =
        formats::load_clouds(read_one(R"("procedural": {"type": "waves", "coverage": 0})"), scene);
    ASSERT_TRUE(warnings);
    ASSERT_EQ(warnings->size(), 1u);
    EXPECT_THAT((*warnings)[0].fault, HasSubstr("0 everywhere"));
    EXPECT_EQ((*warnings)[0].where, "clouds > 0");
    EXPECT_EQ(scene.layers.size(), 1u);
}

TEST(LoadClouds, ItsImagesCountAmongTheInputsAndInTheHash) {
    const TemporaryFolder folder;
    const auto hash_with = [&](float thickness) {
        const formats::Image image{2, 2, std::vector<formats::Rgb>(4, {thickness, 0, 0})};
        EXPECT_TRUE(formats::write_exr(folder / "layer.exr", image));
        const auto media = read_cloud_in(folder, R"("height_field": "layer.exr")");
        Scene scene;
        EXPECT_TRUE(media && formats::apply_media(*media, scene) &&
                    formats::load_clouds(*media, scene));
        EXPECT_EQ(scene.inputs.size(), 2u);
        return scene.sha256;
    };
    const std::string thin = hash_with(1);
    EXPECT_EQ(thin.size(), 64u);
    EXPECT_NE(thin, hash_with(2));
    EXPECT_EQ(thin, hash_with(1));
}

}  // namespace
}  // namespace opaline::tests
