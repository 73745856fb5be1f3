#include "formats/gltf/unlit_glb.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/gltf/gltf_buffer.h"
#include "formats/gltf/unlit_materials.h"

namespace opaline::formats {
namespace {

// What the provenance calls a primitive: `key` is "name" or "material". Empty where it says
// nothing.
std::string provenance_name(const GltfJson& primitives, std::size_t primitive, const char* key) {
    if (!primitives.is_array() || primitive >= primitives.size()) return {};
    const GltfJson& entry = primitives[primitive];
    return entry.is_object() && entry.contains(key) && entry[key].is_string()
               ? entry[key].get<std::string>()
               : "";
}

// "Vase" of "node 'Vase' > mesh 3 > primitive 0"; the whole where the node has no name.
std::string node_name(const std::string& primitive) {
    constexpr std::string_view kBefore = "node '", kAfter = "' > mesh ";
    const std::size_t end = primitive.rfind(kAfter);
    return primitive.starts_with(kBefore) && end != std::string::npos && end > kBefore.size()
               ? primitive.substr(kBefore.size(), end - kBefore.size())
               : primitive;
}

// The array of primitives' names; null where a damaged provenance has none.
GltfJson read_names(std::string_view provenance) {
    const GltfJson root = GltfJson::parse(provenance, nullptr, false);
    const bool has_scene = root.is_object() && root.contains("scene") && root["scene"].is_object();
    return has_scene && root["scene"].contains("primitives") ? root["scene"]["primitives"]
                                                             : GltfJson();
}

Rgb clip(Rgb color, UnlitGlb& glb) {
    const float most = std::max({color.r, color.g, color.b});
    glb.largest = std::max(glb.largest, most);
    if (most > 1) ++glb.clipped;
    return {std::min(color.r, 1.0f), std::min(color.g, 1.0f), std::min(color.b, 1.0f)};
}

std::size_t add_colors(const AssetView& asset, std::uint32_t primitive, std::span<const Rgb> color,
                       GltfBuffer& buffer, UnlitGlb& glb) {
    const PrimitiveRecord& record = asset.primitives[primitive];
    const HoleRecord* const hole = asset.holes.of(primitive);
    const float cover = hole != nullptr ? unlit_cover(*hole) : 1;
    std::vector<Rgb> rgb;
    rgb.reserve(record.vertex_count);
    for (const Rgb c : color.subspan(record.first_vertex, record.vertex_count)) {
        rgb.push_back(clip(cover > 0 ? (1 / cover) * c : Rgb{}, glb));
    }
    if (hole == nullptr || asset.holes.vertex_alpha.empty()) {
        return buffer.add_vectors<Rgb>(rgb, Bounds::none);
    }
    const auto alpha = asset.holes.vertex_alpha.subspan(record.first_vertex, record.vertex_count);
    std::vector<std::array<float, 4>> rgba;
    rgba.reserve(rgb.size());
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        rgba.push_back({rgb[i].r, rgb[i].g, rgb[i].b, alpha[i]});
    }
    return buffer.add_vectors<std::array<float, 4>>(rgba, Bounds::none);
}

}  // namespace

Status check_has_mesh(const AssetView& asset, const std::string& name) {
    const bool has_mesh = std::ranges::any_of(
        asset.primitives, [](const PrimitiveRecord& p) { return p.index_count > 0; });
    return has_mesh ? ok_status()
                    : make_error(ErrorKind::bad_input, name, "", "has no mesh",
                                 "a glTF file holds meshes alone: opaline render shows this file");
}

Result<UnlitGlb> make_unlit_glb(const AssetView& asset, std::span<const Rgb> color,
                                const std::string& name) {
    const GltfJson names = read_names(asset.provenance);
    UnlitGlb glb;
    GltfBuffer buffer;
    UnlitMaterials materials(asset);
    GltfJson roots = GltfJson::array(), nodes = roots, meshes = roots;
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const PrimitiveRecord& record = asset.primitives[p];
        if (record.index_count == 0) continue;
        const auto material = materials.add(p, provenance_name(names, p, "material"), buffer);
        if (!material) return material.error();
        GltfJson attributes = {
            {"POSITION",
             buffer.add_vectors(asset.position.subspan(record.first_vertex, record.vertex_count),
                                Bounds::stated)},
            {"COLOR_0", add_colors(asset, p, color, buffer, glb)}};
        if (materials.has_image(*material)) {
            attributes["TEXCOORD_0"] = buffer.add_vectors(
                asset.texcoord.subspan(record.first_vertex, record.vertex_count), Bounds::none);
        }
        const std::size_t indices =
            buffer.add_indices(asset.index.subspan(record.first_index, record.index_count));
        const std::string own = node_name(provenance_name(names, p, "name"));
        GltfJson mesh, node;
        if (!own.empty()) mesh["name"] = node["name"] = own;
        mesh["primitives"] = GltfJson::array(
            {{{"attributes", attributes}, {"indices", indices}, {"material", *material}}});
        node["mesh"] = meshes.size();
        roots.push_back(nodes.size());
        meshes.push_back(std::move(mesh));
        nodes.push_back(std::move(node));
        glb.vertices += record.vertex_count;
        // Damaged files may list the same vertices again and again.
        if (buffer.bytes().size() > kMostGlbBytes) return refuse_glb_size(name);
    }
    GltfJson document = {{"asset", {{"version", "2.0"}, {"generator", "Opaline"}}},
                         {"extensionsUsed", {"KHR_materials_unlit"}},
                         {"scene", 0},
                         {"scenes", GltfJson::array({{{"nodes", roots}}})},
                         {"nodes", nodes},
                         {"meshes", meshes}};
    materials.put_into(document);
    document["accessors"] = buffer.accessors();
    document["bufferViews"] = buffer.views();
    document["buffers"] = GltfJson::array({{{"byteLength", buffer.bytes().size()}}});
    auto bytes = pack_glb(document, buffer.bytes(), name);
    if (!bytes) return std::move(bytes).error();
    glb.bytes = std::move(*bytes);
    return glb;
}

}  // namespace opaline::formats
