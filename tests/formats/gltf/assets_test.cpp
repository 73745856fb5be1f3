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

TEST(GltfAssets, DragonHasItsVerticesAndUnitNormals) {
    OPALINE_ASSET(path, "gltf/dragon-100k.glb");
    const auto result = formats::import_gltf(path);
    ASSERT_TRUE(result.has_value()) << errors_of(result);
    const auto& p = result->scene.primitives.at(0);
    EXPECT_EQ(p.position.size(), 100250u);
    EXPECT_EQ(p.index.size(), 607560u);
    for (const glm::vec3& normal : p.normal) {
        ASSERT_NEAR(glm::length(normal), 1.0f, 1e-6f);
    }
}

}  // namespace
}  // namespace opaline::tests
