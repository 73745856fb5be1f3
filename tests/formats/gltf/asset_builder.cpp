#include "tests/formats/gltf/asset_builder.h"

#include <fstream>

namespace opaline::tests {

using formats::ImportedScene;
using formats::ImportOptions;
using formats::Result;

std::size_t AssetBuilder::components(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
}

std::size_t AssetBuilder::add_view(const void* data, std::size_t size, std::size_t stride) {
    bin.resize((bin.size() + 3) / 4 * 4);
    Json view = {{"buffer", 0u}, {"byteOffset", bin.size()}, {"byteLength", size}};
    if (stride > 0) {
        view["byteStride"] = stride;
    }
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    bin.insert(bin.end(), bytes, bytes + size);
    json["bufferViews"].push_back(view);
    return json["bufferViews"].size() - 1;
}

std::size_t AssetBuilder::add_accessor(std::size_t view, unsigned component, std::size_t count,
                                       const char* type, bool normalized) {
    Json accessor = {
        {"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}};
    if (normalized) {
        accessor["normalized"] = true;
    }
    json["accessors"].push_back(accessor);
    return json["accessors"].size() - 1;
}

std::size_t AssetBuilder::add_mesh(Json attributes, Json more) {
    more["attributes"] = std::move(attributes);
    json["meshes"].push_back({{"primitives", Json::array({std::move(more)})}});
    return json["meshes"].size() - 1;
}

std::size_t AssetBuilder::add_node(std::size_t mesh, Json more) {
    more["mesh"] = mesh;
    json["nodes"].push_back(std::move(more));
    const std::size_t node = json["nodes"].size() - 1;
    if (!json.contains("scenes")) {
        json["scenes"] = Json::array({{{"nodes", Json::array()}}});
        json["scene"] = 0u;
    }
    json["scenes"][0]["nodes"].push_back(node);
    return node;
}

std::string AssetBuilder::text() const {
    Json whole = json;
    whole["buffers"] =
        Json::array({{{"byteLength", bin.size()},
                      {"uri", "data:application/octet-stream;base64," + base64(bin)}}});
    return whole.dump();
}

std::string AssetBuilder::text_with_external_buffer() const {
    Json whole = json;
    whole["buffers"] = Json::array({{{"byteLength", bin.size()}, {"uri", "buffer.bin"}}});
    return whole.dump();
}

Blob AssetBuilder::glb() const {
    Json whole = json;
    if (!whole.contains("buffers")) {
        whole["buffers"] = Json::array({{{"byteLength", bin.size()}}});
    }
    std::string text = whole.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    Blob padded = bin;
    padded.resize((padded.size() + 3) / 4 * 4);
    Blob out;
    const auto put = [&](std::size_t value) {
        for (int shift = 0; shift < 32; shift += 8) {
            out.push_back(static_cast<std::uint8_t>(value >> shift));
        }
    };
    put(0x46546c67);
    put(2);
    put(12 + 8 + text.size() + 8 + padded.size());
    put(text.size());
    put(0x4e4f534a);
    out.insert(out.end(), text.begin(), text.end());
    put(padded.size());
    put(0x004e4942);
    out.insert(out.end(), padded.begin(), padded.end());
    return out;
}

AssetBuilder triangle_asset() {
    AssetBuilder asset;
    const auto position = asset.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    asset.add_node(asset.add_mesh({{"POSITION", position}}));
    return asset;
}

AssetBuilder textured_triangle(Json material, float other) {
    AssetBuilder asset = triangle_asset();
    Json& primitive = asset.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] = asset.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    primitive["attributes"]["TEXCOORD_1"] = asset.add<float>({0, 0, other, 0, 0, other}, "VEC2");
    primitive["material"] = 0u;
    asset.json["materials"] = Json::array({std::move(material)});
    return asset;
}

void expect_faults(const AssetBuilder& sound, const std::vector<JsonFault>& faults) {
    for (const auto& [pointer, value, fault] : faults) {
        AssetBuilder asset = sound;
        const Json::json_pointer at(pointer);
        if (value.is_discarded()) {
            asset.json[at.parent_pointer()].erase(at.back());
        } else {
            asset.json[at] = value;
        }
        EXPECT_THAT(errors_of(import_asset(asset)), ::testing::HasSubstr(fault))
            << pointer << " = " << value;
    }
}

std::string base64(const Blob& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            bits = bits << 8 | (i + j < bytes.size() ? bytes[i + j] : 0u);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            text += i + j <= bytes.size() ? kDigits[bits >> (18 - 6 * j) & 63] : '=';
        }
    }
    return text;
}

void write_file(const std::filesystem::path& path, const void* data, std::size_t size) {
    std::ofstream(path, std::ios::binary)
        .write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}
void write_file(const std::filesystem::path& path, const std::string& text) {
    write_file(path, text.data(), text.size());
}
void write_file(const std::filesystem::path& path, const Blob& bytes) {
    write_file(path, bytes.data(), bytes.size());
}

Result<ImportedScene> import_bytes(const Blob& bytes) {
    const TemporaryFolder folder;
    write_file(folder / "asset.glb", bytes);
    return formats::import_gltf(folder / "asset.glb");
}

Result<ImportedScene> import_text(const std::string& text) {
    const TemporaryFolder folder;
    write_file(folder / "asset.gltf", text);
    return formats::import_gltf(folder / "asset.gltf");
}

Result<ImportedScene> import_asset(const AssetBuilder& asset, const ImportOptions& options) {
    const TemporaryFolder folder;
    write_file(folder / "asset.glb", asset.glb());
    return formats::import_gltf(folder / "asset.glb", options);
}

ImportedScene must_import(const AssetBuilder& asset, const ImportOptions& options) {
    auto result = import_asset(asset, options);
    EXPECT_TRUE(result.has_value()) << errors_of(result);
    return result ? std::move(result).value() : ImportedScene{};
}

std::string lines(const std::vector<formats::Diagnostic>& diagnostics) {
    std::string text;
    for (const auto& one : diagnostics) {
        text += one.where + ": " + one.fault + " (" + one.remedy + ")\n";
    }
    return text;
}

std::string errors_of(const Result<ImportedScene>& result) {
    return result ? "" : lines(result.error().diagnostics);
}

AssetBuilder rich_asset() {
    AssetBuilder asset = triangle_asset();
    Json& primitive = asset.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] =
        asset.add<std::uint8_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, "VEC4", true);
    primitive["indices"] = asset.add<std::uint16_t>({0, 1, 2}, "SCALAR");
    primitive["material"] = 0u;
    asset.json["materials"] = Json::array(
        {{{"name", "m"},
          {"alphaMode", "MASK"},
          {"alphaCutoff", 0.5},
          {"emissiveFactor", {1, 1, 0}},
          {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}}}}}});
    asset.json["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::array({{{"type", "spot"},
                      {"intensity", 3},
                      {"color", {1, 1, 1}},
                      {"range", 9},
                      {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}});
    asset.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
        {"diffuseFactor", {1, 0.5, 0, 1}}, {"glossinessFactor", 0.5}};
    primitive["attributes"]["JOINTS_0"] = asset.add<std::uint8_t>(Blob(12, 0), "VEC4");
    primitive["attributes"]["WEIGHTS_0"] = asset.add<std::uint8_t>(Blob(12, 255), "VEC4", true);
    primitive["targets"] =
        Json::array({{{"POSITION", asset.add<std::int8_t>({0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3")}}});
    asset.json["meshes"][0]["weights"] = {1};
    asset.json["skins"] = Json::array({{{"joints", {1u}}}});
    asset.json["nodes"][0]["skin"] = 0u;
    asset.json["nodes"].push_back({{"children", {0u}}, {"rotation", {0, 0, 0, 1}}});
    asset.json["nodes"][1]["mesh"] = 0u;
    asset.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        asset.add<float>({1, 2, 3}, "VEC3");
    asset.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0u;
    asset.json["scenes"][0]["nodes"] = {1u};
    return asset;
}

AssetBuilder asset_with_extensions(Json extensions) {
    AssetBuilder asset = triangle_asset();
    asset.json["meshes"][0]["primitives"][0]["material"] = 0u;
    asset.json["materials"] =
        Json::array({{{"name", "Wax"},
                      {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.25}}},
                      {"extensions", std::move(extensions)}}});
    return asset;
}

Json scattering_extensions() {
    return {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
            {"KHR_materials_volume",
             {{"thicknessFactor", 1},
              {"attenuationDistance", 0.02},
              {"attenuationColor", {0.9, 0.5, 0.25}}}},
            {"KHR_materials_scatter",
             {{"scatterStrengthFactor", 1},
              {"multiscatterColorFactor", {0.8, 0.5, 0}},
              {"scatterAnisotropy", 0.5}}}};
}

}  // namespace opaline::tests
