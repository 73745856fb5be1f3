#include "tests/cli/small_scene.h"

#include <cmath>
#include <map>
#include <utility>

#include "formats/image/exr.h"
#include "formats/opal/rgb.h"
#include "formats/opal/write_opal.h"

namespace opaline::tests {
namespace {

/// Facing up at height y, corners at +-half.
Json add_square(AssetBuilder& asset, float y, float half, unsigned material) {
    const auto position =
        asset.add<float>({-half, y, -half, -half, y, half, half, y, half, half, y, -half}, "VEC3");
    const auto index = asset.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    const auto normal = asset.add<float>({0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}, "VEC3");
    return {{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
            {"indices", index},
            {"material", material}};
}

}  // namespace

AssetBuilder two_squares() {
    // Diffuse alone: what a dielectric reflects besides is not this scene's matter.
    const Json no_specular = {{"KHR_materials_specular", {{"specularFactor", 0}}}};
    AssetBuilder asset;
    const Json low = add_square(asset, 0, 1, 0), high = add_square(asset, 0.5f, 0.5f, 1);
    asset.json["meshes"] = Json::array({{{"primitives", {low, high}}}});
    asset.json["materials"] = {
        {{"name", "Chalk"},
         {"extensions", no_specular},
         {"pbrMetallicRoughness",
          {{"metallicFactor", 0}, {"baseColorFactor", {0.8, 0.8, 0.8, 1}}}}},
        {{"name", "Brick"},
         {"extensions", no_specular},
         {"pbrMetallicRoughness",
          {{"metallicFactor", 0}, {"baseColorFactor", {0.7, 0.2, 0.1, 1}}}}}};
    asset.add_node(0);
    return asset;
}

AssetBuilder wavy_sheet(unsigned n) {
    std::vector<float> position, normal;
    std::vector<std::uint32_t> index;
    for (unsigned z = 0; z < n; ++z) {
        for (unsigned x = 0; x < n; ++x) {
            const auto u = static_cast<float>(x), v = static_cast<float>(z);
            position.insert(position.end(), {u, 3 * std::sin(0.3f * u) * std::sin(0.3f * v), v});
            normal.insert(normal.end(), {-0.9f * std::cos(0.3f * u) * std::sin(0.3f * v), 1,
                                         -0.9f * std::sin(0.3f * u) * std::cos(0.3f * v)});
            if (x + 1 < n && z + 1 < n) {
                const unsigned a = z * n + x;
                index.insert(index.end(), {a, a + n, a + n + 1, a, a + n + 1, a + 1});
            }
        }
    }
    AssetBuilder asset;
    const auto positions = asset.add<float>(position, "VEC3");
    const auto indices = asset.add<std::uint32_t>(index, "SCALAR");
    const auto normals = asset.add<float>(normal, "VEC3");
    asset.add_node(
        asset.add_mesh({{"POSITION", positions}, {"NORMAL", normals}}, {{"indices", indices}}));
    return asset;
}

double mean_of_picture(const std::string& path) {
    const auto picture = formats::read_exr(path);
    EXPECT_TRUE(picture) << path;
    double sum = 0;
    for (const formats::Rgb& pixel : picture->pixel) {
        sum += static_cast<double>(formats::luminance(pixel));
    }
    return sum / static_cast<double>(picture->pixel.size());
}

SmallScene::SmallScene() {
    write_file(scene(), two_squares().glb());
}

std::string SmallScene::baked() {
    static std::map<std::string, std::string> bakes;  // by the scene's bytes
    const std::string file = path("scene.opal");
    if (std::filesystem::exists(file)) return file;
    std::string& bake = bakes[read_text(scene())];
    if (bake.empty()) {
        run_well({"bake", scene(), "-o", file, "--cubemap", "16", "--coefficients", "all",
                  "--refine", "off"});
        bake = read_text(file);
    } else {
        write_file(file, bake);
    }
    return file;
}

std::string SmallScene::write(const formats::Asset& asset, const std::string& name) const {
    auto file = formats::AtomicFile::create(path(name));
    EXPECT_TRUE(file && formats::write_opal(asset.view(), std::move(*file)));
    return path(name);
}

}  // namespace opaline::tests
