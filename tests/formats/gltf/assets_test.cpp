#include <filesystem>

#include "tests/formats/gltf/asset_builder.h"
#include "tests/support/assets.h"

namespace opaline::tests {
namespace {

TEST(GltfAssets, EveryModelLoadsOrIsRefusedWithAMessage) {
    OPALINE_ASSET(folder, "gltf");
    std::size_t models = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const auto result = formats::import_gltf(entry.path());
        ++models;
        if (!result) {
            EXPECT_FALSE(errors_of(result).empty()) << entry.path();
            continue;
        }
        EXPECT_GT(result->scene.primitives.size(), 0u) << entry.path();
    }
    EXPECT_GT(models, 0u);
}

}  // namespace
}  // namespace opaline::tests
