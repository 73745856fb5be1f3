#include "tests/formats/gltf/compressed_sheets.h"

#include <draco/attributes/geometry_attribute.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

namespace opaline::tests {

std::vector<float> sheet_positions() {
    std::vector<float> out;
    for (unsigned y = 0; y < kSheetSide; ++y) {
        for (unsigned x = 0; x < kSheetSide; ++x) {
            out.insert(out.end(), {float(x), float(y), float((x * y) % 5) * 0.25f});
        }
    }
    return out;
}

std::vector<std::uint32_t> sheet_indices() {
    std::vector<std::uint32_t> out;
    for (unsigned y = 0; y + 1 < kSheetSide; ++y) {
        for (unsigned x = 0; x + 1 < kSheetSide; ++x) {
            const unsigned i = y * kSheetSide + x;
            out.insert(out.end(),
                       {i, i + 1, i + kSheetSide, i + 1, i + kSheetSide + 1, i + kSheetSide});
        }
    }
    return out;
}

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

AssetBuilder draco_sheet(DracoMethod method) {
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
    encoder.SetEncodingMethod(
        method == DracoMethod::sequential
            ? draco::MESH_SEQUENTIAL_ENCODING
            : draco::MESH_EDGEBREAKER_ENCODING);  // without quantisation: lossless
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

}  // namespace opaline::tests
