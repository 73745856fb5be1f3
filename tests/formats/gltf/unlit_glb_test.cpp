// The glTF files that show an asset in one light, read back.
#include "formats/gltf/unlit_glb.h"

#include <algorithm>

#include "formats/opal/thin_glass.h"
#include "tests/formats/gltf/asset_builder.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/hole_fixture.h"

namespace opaline::tests {
namespace {

using formats::Asset;
using formats::Material;
using formats::Rgb;
using formats::UnlitGlb;
using formats::Wrap;

// A colour of its own for each vertex, at most `most`.
std::vector<Rgb> vertex_colors(const Asset& asset, float most = 1) {
    std::vector<Rgb> colors;
    const auto count = static_cast<float>(asset.position.size());
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        const float share = static_cast<float>(v) / count;
        colors.push_back({most * share, most * (1 - share), 0.1f * most});
    }
    return colors;
}

UnlitGlb write_unlit(const Asset& asset, const std::vector<Rgb>& colors) {
    auto glb = formats::make_unlit_glb(asset.view(), colors, "test.opal");
    EXPECT_TRUE(glb);
    return std::move(*glb);
}

formats::Scene read_back(const UnlitGlb& glb) {
    auto imported = import_bytes(Blob(glb.bytes.begin(), glb.bytes.end()));
    EXPECT_TRUE(imported);
    return std::move(imported->scene);
}

Json document_of(const UnlitGlb& glb) {
    const std::string& b = glb.bytes;
    const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(b[i])}; };
    const std::size_t size = byte(12) | byte(13) << 8u | byte(14) << 16u;
    return Json::parse(b.substr(20, size));
}

TEST(UnlitGlb, HoldsTheVerticesTrianglesColoursAndImagesOfTheAsset) {
    Asset asset = make_small_asset();
    asset.primitives[1].wrap_u = formats::nearest(Wrap::mirror);
    asset.primitives[1].wrap_v = formats::nearest(Wrap::clamp);
    const std::vector<Rgb> colors = vertex_colors(asset);
    const UnlitGlb glb = write_unlit(asset, colors);
    EXPECT_EQ(glb.clipped, 0u);
    EXPECT_EQ(glb.vertices, asset.position.size());
    const formats::Scene scene = read_back(glb);
    ASSERT_EQ(scene.primitives.size(), 2u);
    for (std::size_t p = 0; p < 2; ++p) {
        const formats::Primitive& read = scene.primitives[p];
        const formats::PrimitiveRecord& record = asset.primitives[p];
        ASSERT_EQ(read.position.size(), record.vertex_count);
        for (std::uint32_t v = 0; v < record.vertex_count; ++v) {
            const auto expected = asset.position[record.first_vertex + v];
            const glm::dvec3 position = scene.to_world(read.position[v]);
            EXPECT_EQ(position, glm::dvec3(expected.x, expected.y, expected.z));
            EXPECT_EQ(read.color[v], colors[record.first_vertex + v]);
        }
        EXPECT_TRUE(std::ranges::equal(
            read.index, std::span(asset.index).subspan(record.first_index, record.index_count)));
    }
    EXPECT_EQ(scene.materials[scene.primitives[0].material].base_color_image, formats::kNone);
    const Material& textured = scene.materials[scene.primitives[1].material];
    EXPECT_EQ(textured.wrap_u, asset.primitives[1].wrap_u);
    EXPECT_EQ(textured.wrap_v, asset.primitives[1].wrap_v);
    EXPECT_EQ(scene.primitives[1].texcoord[2], glm::vec2(0, 1));
    ASSERT_EQ(scene.images.size(), 1u);
    const Blob codes = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
    EXPECT_EQ(scene.images[0].rgba, codes);
}

TEST(UnlitGlb, ClipsWhatGltfDoesNotAllowAndCountsIt) {
    const Asset asset = make_small_asset();
    const UnlitGlb glb = write_unlit(asset, vertex_colors(asset, 2));
    EXPECT_EQ(glb.clipped, 7u);  // all but the fifth, whose largest share is a half
    EXPECT_FLOAT_EQ(glb.largest, 2);
    const formats::Scene scene = read_back(glb);
    EXPECT_EQ(scene.primitives[0].color[0], (Rgb{0, 1, 0.2f}));
    EXPECT_EQ(scene.primitives[1].color[0], (Rgb{1, 1, 0.2f}));
}

TEST(UnlitGlb, AlphaIsThatOfMaterialVerticesAndImage) {
    const Asset asset = make_hole_asset();
    const formats::Scene scene = read_back(write_unlit(asset, vertex_colors(asset)));
    const formats::Primitive &blend = scene.primitives[0], &mask = scene.primitives[1];
    EXPECT_EQ(scene.materials[blend.material].alpha_mode, Material::AlphaMode::blend);
    EXPECT_EQ(scene.materials[blend.material].alpha, 0.25f);
    EXPECT_EQ(blend.alpha, (std::vector<float>{0, 0.25f, 0.5f, 0.75f}));
    const Material& masked = scene.materials[mask.material];
    EXPECT_EQ(masked.alpha_mode, Material::AlphaMode::mask);
    EXPECT_EQ(masked.alpha_cutoff, 0.75f);
    // The base colour's image, with the first channel of the same one as alpha.
    const Blob codes = {255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 0, 255, 255, 255, 255};
    EXPECT_EQ(scene.images[masked.base_color_image].rgba, codes);
}

// Blending adds alpha times colour, and leaves 1 - alpha of what is behind.
TEST(UnlitGlb, ThinGlassShowsItsOwnLightOverWhatPasses) {
    Asset asset = make_small_asset();
    asset.holes.record = {{.primitive = 0, .cutoff = 0}};
    formats::store_clear_share({0.5f, 1.5f}, asset.holes.record[0]);
    const UnlitGlb glb = write_unlit(asset, std::vector<Rgb>(8, Rgb{0.25f, 0.125f, 0}));
    const formats::Scene scene = read_back(glb);
    const Material& glass = scene.materials[scene.primitives[0].material];
    EXPECT_EQ(glass.alpha_mode, Material::AlphaMode::blend);
    EXPECT_NEAR(1 - glass.alpha, 0.5f * formats::thin_glass_transmittance(1, 1.5f), 1e-6);
    EXPECT_NEAR(glass.alpha * scene.primitives[0].color[0].r, 0.25f, 1e-6);
    EXPECT_EQ(scene.primitives[1].color[0].r, 0.25f);
}

TEST(UnlitGlb, NodesHaveTheNamesOfTheProvenanceWhereItHasThem) {
    Asset asset = make_small_asset();
    const std::vector<Rgb> colors = vertex_colors(asset);
    asset.provenance =
        R"({"scene":{"primitives":[{"name":"node 'Vase' > mesh 3 > primitive 0","material":"Jade"},
            {"name":7}]}})";
    const Json named = document_of(write_unlit(asset, colors));
    EXPECT_EQ(named["nodes"][0]["name"], "Vase");
    EXPECT_EQ(named["materials"][0]["name"], "Jade");
    EXPECT_FALSE(named["nodes"][1].contains("name"));
    for (const char* damaged : {"", "[", "7", R"({"scene":[]})", R"({"scene":{"primitives":3}})"}) {
        asset.provenance = damaged;
        EXPECT_FALSE(document_of(write_unlit(asset, colors))["nodes"][0].contains("name"));
    }
}

TEST(UnlitGlb, MaterialsAndImagesThatAreAlikeStandOnce) {
    Asset asset = make_small_asset();
    asset.primitives[0].base_color_image = 0;
    Json document = document_of(write_unlit(asset, vertex_colors(asset)));
    EXPECT_EQ(document["materials"].size(), 1u);
    EXPECT_EQ(document["images"].size(), 1u);
    asset.primitives[0].flags = formats::PrimitiveRecord::kDoubleSided;
    document = document_of(write_unlit(asset, vertex_colors(asset)));
    EXPECT_EQ(document["materials"].size(), 2u);
    EXPECT_EQ(document["materials"][0]["doubleSided"], true);
    EXPECT_EQ(document["images"].size(), 1u);
}

TEST(UnlitGlb, AnAssetWithoutATriangleIsRefused) {
    Asset asset = make_small_asset();
    EXPECT_TRUE(formats::check_has_mesh(asset.view(), "a.opal"));
    for (auto& primitive : asset.primitives) {
        primitive.index_count = 0;
    }
    const auto refused = formats::check_has_mesh(asset.view(), "a.opal");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, formats::ErrorKind::bad_input);
}

}  // namespace
}  // namespace opaline::tests
