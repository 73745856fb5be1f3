#include <meshoptimizer.h>

#include "tests/formats/gltf/compressed_sheets.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;

/// The corners of every triangle as text, in an order that does not depend on numbering.
std::vector<std::string> triangle_soup(const std::vector<glm::vec3>& position,
                                       const std::vector<std::uint32_t>& index) {
    std::vector<std::string> soup;
    for (std::size_t t = 0; t < index.size(); t += 3) {
        std::vector<std::string> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3 p = position[index[t + k]];
            corners.push_back(std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' +
                              std::to_string(p.z) + ' ');
        }
        // Rotated so that the smallest comes first: keeps the winding.
        const auto first = std::min_element(corners.begin(), corners.end()) - corners.begin();
        std::rotate(corners.begin(), corners.begin() + first, corners.end());
        soup.push_back(corners[0] + corners[1] + corners[2]);
    }
    std::sort(soup.begin(), soup.end());
    return soup;
}

std::vector<std::string> expected_soup() {
    const auto numbers = sheet_positions();
    std::vector<glm::vec3> position;
    for (std::size_t i = 0; i < numbers.size(); i += 3) {
        position.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    }
    return triangle_soup(position, sheet_indices());
}

TEST(GltfCompression, MeshoptDecodesToTheSameVerticesAndTriangles) {
    const auto imported = must_import(meshopt_sheet(), {.smooth_angle = 180});
    const auto& p = imported.scene.primitives.at(0);
    const auto positions = sheet_positions();
    ASSERT_EQ(p.position.size() * 3, positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        EXPECT_EQ(p.position[i / 3][int(i % 3)], positions[i]);  // order is kept
    }
    EXPECT_EQ(triangle_soup(p.position, p.index), expected_soup());
}

TEST(GltfCompression, MeshoptFiltersAreUndone) {
    AssetBuilder asset = triangle_asset();
    const float normals[12] = {0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0};
    Blob filtered(12);
    meshopt_encodeFilterOct(filtered.data(), 3, 4, 8, normals);
    Blob data(meshopt_encodeVertexBufferBound(3, 4));
    data.resize(meshopt_encodeVertexBuffer(data.data(), data.size(), filtered.data(), 3, 4));
    const auto view = asset.add_view(data.data(), data.size(), 4);
    Json& entry = asset.json["bufferViews"][view];
    entry["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0u},
                                                      {"byteOffset", entry["byteOffset"]},
                                                      {"byteLength", data.size()},
                                                      {"byteStride", 4u},
                                                      {"count", 3u},
                                                      {"mode", "ATTRIBUTES"},
                                                      {"filter", "OCTAHEDRAL"}};
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add_accessor(view, 5120, 3, "VEC3", true);
    const auto imported = must_import(asset);
    const auto& normal = imported.scene.primitives.at(0).normal;
    EXPECT_LT(glm::length(normal[0] - glm::vec3(0, 0, 1)), 0.02f);  // 8 bits
    EXPECT_LT(glm::length(normal[1] - glm::vec3(1, 0, 0)), 0.02f);
    EXPECT_LT(glm::length(normal[2] - glm::vec3(0, 1, 0)), 0.02f);
}

TEST(GltfCompression, DracoDecodesToTheSameTriangles) {
    for (const DracoMethod method : {DracoMethod::sequential, DracoMethod::edgebreaker}) {
        const auto imported = must_import(draco_sheet(method), {.smooth_angle = 180});
        const auto& p = imported.scene.primitives.at(0);
        EXPECT_EQ(p.position.size(), kSheetSide * kSheetSide);
        EXPECT_EQ(triangle_soup(p.position, p.index), expected_soup());
    }
}

TEST(GltfCompression, DamagedDescriptionsAreErrorsWithTheRemedy) {
    const std::string view = "/bufferViews/0/extensions/EXT_meshopt_compression/";
    for (const auto& [key, value] :
         std::vector<std::pair<const char*, Json>>{{"byteStride", 7u},
                                                   {"count", 1'000'000'000u},
                                                   {"mode", "ZIP"},
                                                   {"buffer", 9u},
                                                   {"byteLength", 1'000'000u},
                                                   {"filter", "QUATERNION"},
                                                   {"count", nullptr}}) {
        expect_faults(meshopt_sheet(), {{view + key, value, "decompress with gltfpack"}});
    }
    const std::string mesh = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/";
    const char* const remedy = "export without compression";
    expect_faults(draco_sheet(DracoMethod::edgebreaker),
                  {{mesh + "bufferView", 9u, remedy},
                   {mesh + "attributes", 1u, remedy},
                   {mesh + "attributes/POSITION", 77u, remedy}});
}

}  // namespace
}  // namespace opaline::tests
