#include <cstdlib>
#include <filesystem>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

std::filesystem::path assets_folder() {
    const char* given = std::getenv("OPALINE_ASSETS_DIR");
    return given ? std::filesystem::path(given)
                 : std::filesystem::path(OPALINE_SOURCE_DIR) / "../shared/assets";
}

TEST(GltfAssets, EveryModelLoadsOrIsRefusedWithAMessage) {
    const auto folder = assets_folder() / "gltf";
    if (!std::filesystem::is_directory(folder)) {
        GTEST_SKIP() << "no assets at " << folder << "; set OPALINE_ASSETS_DIR";
    }
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
    const auto path = assets_folder() / "gltf/dragon-100k.glb";
    if (!std::filesystem::exists(path)) {
        GTEST_SKIP() << "no asset at " << path << "; set OPALINE_ASSETS_DIR";
    }
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
