#include <draco/attributes/geometry_attribute.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;

constexpr unsigned kSide = 12;

/// A wavy sheet of kSide * kSide vertices with exactly representable coordinates.
std::vector<float> sheet_positions() {
    std::vector<float> out;
    for (unsigned y = 0; y < kSide; ++y) {
        for (unsigned x = 0; x < kSide; ++x) {
            out.insert(out.end(), {float(x), float(y), float((x * y) % 5) * 0.25f});
        }
    }
    return out;
}

std::vector<std::uint32_t> sheet_indices() {
    std::vector<std::uint32_t> out;
    for (unsigned y = 0; y + 1 < kSide; ++y) {
        for (unsigned x = 0; x + 1 < kSide; ++x) {
            const unsigned i = y * kSide + x;
            out.insert(out.end(), {i, i + 1, i + kSide, i + 1, i + kSide + 1, i + kSide});
        }
    }
    return out;
}

/// Both buffer views of the sheet in EXT_meshopt_compression, over a placeholder buffer.
AssetBuilder meshopt_sheet() {
    const auto positions = sheet_positions();
    const auto indices = sheet_indices();
    const std::size_t vertices = positions.size() / 3;
    Blob vertex_data(meshopt_encodeVertexBufferBound(vertices, 12));
    vertex_data.resize(meshopt_encodeVertexBuffer(vertex_data.data(), vertex_data.size(),
                                                  positions.data(), vertices, 12));
    Blob index_data(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    index_data.resize(meshopt_encodeIndexBuffer(index_data.data(), index_data.size(),
                                                indices.data(), indices.size()));
    AssetBuilder asset;
    const auto add = [&](const Blob& data, std::size_t count, std::size_t stride,
                         const char* mode) {
        const auto view = asset.add_view(data.data(), data.size());
        Json& entry = asset.json["bufferViews"][view];
        Json compressed = {{"buffer", 0u},
                           {"byteOffset", entry["byteOffset"]},
                           {"byteLength", data.size()},
                           {"byteStride", stride},
                           {"count", count},
                           {"mode", mode}};
        entry = {{"buffer", 1u},
                 {"byteOffset", 0u},
                 {"byteLength", count * stride},
                 {"extensions", {{"EXT_meshopt_compression", compressed}}}};
        return view;
    };
    const auto vertex_view = add(vertex_data, vertices, 12, "ATTRIBUTES");
    const auto index_view = add(index_data, indices.size(), 4, "TRIANGLES");
    const auto position = asset.add_accessor(vertex_view, 5126, vertices, "VEC3");
    const auto index = asset.add_accessor(index_view, 5125, indices.size(), "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", position}}, {{"indices", index}}));
    asset.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    asset.json["buffers"] =
        Json::array({{{"byteLength", asset.bin.size()}},
                     {{"byteLength", 4096u},
                      {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
    return asset;
}

AssetBuilder draco_sheet(int method) {
    const auto positions = sheet_positions();
    const auto indices = sheet_indices();
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(positions.size() / 3));
    draco::GeometryAttribute description;
    description.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12,
                     0);
    const int id = mesh.AddAttribute(description, true, mesh.num_points());
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &positions[3 * i]);
    }
    for (std::size_t t = 0; t < indices.size(); t += 3) {
        mesh.AddFace({draco::PointIndex(indices[t]), draco::PointIndex(indices[t + 1]),
                      draco::PointIndex(indices[t + 2])});
    }
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);  // without quantisation: lossless
    draco::EncoderBuffer data;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &data).ok());

    AssetBuilder asset;
    const auto view = asset.add_view(data.data(), data.size());
    asset.json["accessors"] =
        Json::array({{{"componentType", 5126u}, {"count", mesh.num_points()}, {"type", "VEC3"}},
                     {{"componentType", 5125u}, {"count", indices.size()}, {"type", "SCALAR"}}});
    const Json extension = {
        {"bufferView", view},
        {"attributes", {{"POSITION", static_cast<unsigned>(mesh.attribute(id)->unique_id())}}}};
    asset.add_node(asset.add_mesh(
        {{"POSITION", 0u}},
        {{"indices", 1u}, {"extensions", {{"KHR_draco_mesh_compression", extension}}}}));
    asset.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return asset;
}

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
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const auto imported = must_import(draco_sheet(method), {.smooth_angle = 180});
        const auto& p = imported.scene.primitives.at(0);
        EXPECT_EQ(p.position.size(), kSide * kSide);
        EXPECT_EQ(triangle_soup(p.position, p.index), expected_soup()) << method;
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
    expect_faults(draco_sheet(draco::MESH_EDGEBREAKER_ENCODING),
                  {{mesh + "bufferView", 9u, remedy},
                   {mesh + "attributes", 1u, remedy},
                   {mesh + "attributes/POSITION", 77u, remedy}});
}

TEST(GltfCompression, FlippedBitsNeverCrash) {
    std::size_t refused = 0, cases = 0;
    for (const AssetBuilder& whole : {meshopt_sheet(), draco_sheet(draco::MESH_SEQUENTIAL_ENCODING),
                                      draco_sheet(draco::MESH_EDGEBREAKER_ENCODING)}) {
        for (std::size_t bit = 0; bit < whole.bin.size() * 8; bit += 101) {
            AssetBuilder damaged = whole;
            damaged.bin[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
            const auto result = import_asset(damaged);
            ++cases;
            refused += result ? 0 : 1;
            if (result) {
                for (const auto i : result->scene.primitives.at(0).index) {
                    ASSERT_LT(i, result->scene.primitives[0].position.size());
                }
            }
        }
    }
    EXPECT_GT(cases, 300u);
    EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace opaline::tests
