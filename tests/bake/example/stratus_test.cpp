#include "bake/example/scene_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "bake/example/example_scenes.h"
#include "formats/image/srgb.h"
#include "formats/media/load_clouds.h"
#include "formats/media/read_media.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

TEST(Stratus, IsAMediaFileOfALayerOverItsGround) {
    const tests::TemporaryFolder folder;
    const auto files = write_example("stratus", folder.path());
    ASSERT_TRUE(files);
    EXPECT_THAT(*files, testing::ElementsAre(folder / "stratus.json", folder / "stratus.png"));
    EXPECT_TRUE(make_example("stratus")->empty()) << "no mesh";
    const auto media = formats::read_media(files->front());
    ASSERT_TRUE(media) << media.error().diagnostics.front().fault;
    EXPECT_EQ(media->inputs.size(), 2u);
    formats::Scene scene;
    ASSERT_TRUE(formats::load_clouds(*media, scene));
    ASSERT_EQ(scene.layers.size(), 1u);
    const formats::CloudLayer& layer = scene.layers[0];
    EXPECT_TRUE(layer.repeats);
    EXPECT_EQ(layer.ground_columns, 512u);
    EXPECT_EQ(layer.ground_rows, 512u);
    EXPECT_FLOAT_EQ(*std::max_element(layer.thickness.begin(), layer.thickness.end()), 240);
    EXPECT_GT(std::count(layer.thickness.begin(), layer.thickness.end(), 0.0f), 0);
}

// Dark water and bright ice, so that the base of the cloud shows which of them is below.
TEST(Stratus, GroundIsWaterAndIceAndRepeatsWithoutASeam) {
    const formats::Image ground = formats::to_linear(make_icy_sea());
    const auto albedo = [&](std::uint32_t x, std::uint32_t y) {
        return ground.pixel[y * ground.width + x].g;
    };
    double water = 0, ice = 0;
    for (const formats::Rgb& pixel : ground.pixel) {
        EXPECT_LT(std::max({pixel.r, pixel.g, pixel.b}), 0.9f);
        water += pixel.g < 0.1f;
        ice += pixel.g > 0.5f;
    }
    const double all = static_cast<double>(ground.pixel.size());
    EXPECT_GT(water / all, 0.3);
    EXPECT_GT(ice / all, 0.3);
    EXPECT_LT(1 - (water + ice) / all, 0.1);
    int seam = 0, middle = 0;  // texels where water meets ice
    for (std::uint32_t i = 0; i < ground.width; ++i) {
        const auto meet = [&](float a, float b) { return std::abs(a - b) > 0.3f; };
        seam += meet(albedo(ground.width - 1, i), albedo(0, i)) +
                meet(albedo(i, ground.height - 1), albedo(i, 0));
        middle += meet(albedo(100, i), albedo(101, i)) + meet(albedo(i, 100), albedo(i, 101));
    }
    EXPECT_LE(seam, 2 * middle + 10);
}

}  // namespace
}  // namespace opaline::bake
