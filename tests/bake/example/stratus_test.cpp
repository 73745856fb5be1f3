#include "bake/lab/example/scene_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bake/lab/example/example_scenes.h"
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

}  // namespace
}  // namespace opaline::bake
