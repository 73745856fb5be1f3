#include "formats/gltf/decode_draco.h"

#include <draco/compression/decode.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;
constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kDracoRemedy =
    "export without compression, or decompress with gltf-transform";

std::optional<Bytes> compressed_bytes(const Json& root, const Json& extension,
                                      const Resources& resources) {
    const auto view_index = whole_in(extension, "bufferView");
    const Json* views = find_member(root, "bufferViews");
    if (!view_index || !views || *view_index >= views->size()) return std::nullopt;
    const Json& view = (*views)[*view_index];
    const auto buffer = whole_in(view, "buffer");
    const auto length = whole_in(view, "byteLength");
    const std::uint64_t offset = whole_in(view, "byteOffset").value_or(0);
    if (!buffer || *buffer >= resources.buffers.size() || !length) return std::nullopt;
    const Bytes bytes = resources.buffers[*buffer];
    if (offset > bytes.size() || *length > bytes.size() - offset) return std::nullopt;
    return bytes.subspan(offset, *length);
}

/// Adds one view of decoded bytes and an accessor on it; returns the accessor's index.
std::size_t add_accessor(Json& root, Resources& resources, std::vector<std::byte> bytes,
                         Json accessor) {
    Json& views = root["bufferViews"];
    accessor["bufferView"] = views.size();
    accessor["byteOffset"] = 0u;
    accessor.erase("sparse");
    views.push_back({{"buffer", resources.buffers.size()}, {"byteLength", bytes.size()}});
    resources.buffers.push_back(resources.keep(std::move(bytes)));
    root["accessors"].push_back(std::move(accessor));
    return root["accessors"].size() - 1;
}

/// The counts at the head of a Draco mesh (bitstream 2.2, the one that glTF allows), checked before
/// the decoder allocates by them: an edgebreaker face takes about a bit, so more than 64 faces or
/// vertices a byte are not a mesh but an attempt to exhaust memory. Empty where it is sound.
std::string header_fault(Bytes bytes) {
    const auto byte = [&](std::size_t i) { return std::to_integer<std::uint32_t>(bytes[i]); };
    if (bytes.size() < 16 || std::memcmp(bytes.data(), "DRACO", 5) != 0) {
        return "the compressed data does not start with a Draco header";
    }
    if (byte(5) != 2 || byte(6) != 2 || byte(7) != 1 || byte(8) > 1 || (byte(10) & 0x80) != 0) {
        return "the compressed data is not a plain mesh of Draco bitstream 2.2";
    }
    std::size_t at = 11 + byte(8);  // edgebreaker stores one more byte, its traversal
    const auto varint = [&] {
        std::uint64_t value = 0;
        for (int shift = 0; at < bytes.size() && shift < 35; shift += 7) {
            const std::uint64_t digit = byte(at++);
            value |= (digit & 0x7f) << shift;
            if (digit < 0x80) return value;
        }
        return ~std::uint64_t{0};
    };
    std::uint64_t largest = std::max(varint(), varint());  // vertices and faces
    if (byte(8) == 1) {
        ++at;                                               // number of attribute decoders
        largest = std::max({largest, varint(), varint()});  // symbols, split symbols
    }
    return largest > 64 * std::uint64_t{bytes.size()}
               ? "the compressed data claims more faces or vertices than it can hold"
               : "";
}

template <class T>
bool copy_values(const draco::PointAttribute& attribute, std::uint32_t points,
                 std::uint32_t components, std::vector<std::byte>& out) {
    out.resize(std::size_t{points} * components * sizeof(T));
    for (std::uint32_t i = 0; i < points; ++i) {
        T value[4] = {};
        if (!attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(i)),
                                       static_cast<std::int8_t>(components), value)) {
            return false;
        }
        std::memcpy(out.data() + std::size_t{i} * components * sizeof(T), value,
                    components * sizeof(T));
    }
    return true;
}

/// The attribute's values in the type that its accessor declares.
bool attribute_bytes(const draco::PointAttribute& attribute, std::uint32_t points,
                     std::uint64_t component_type, std::uint32_t components,
                     std::vector<std::byte>& out) {
    switch (component_type) {
        case 5120:
            return copy_values<std::int8_t>(attribute, points, components, out);
        case 5121:
            return copy_values<std::uint8_t>(attribute, points, components, out);
        case 5122:
            return copy_values<std::int16_t>(attribute, points, components, out);
        case 5123:
            return copy_values<std::uint16_t>(attribute, points, components, out);
        case 5125:
            return copy_values<std::uint32_t>(attribute, points, components, out);
        case 5126:
            return copy_values<float>(attribute, points, components, out);
        default:
            return false;
    }
}

std::uint32_t component_count(const Json& accessor) {
    const std::string name = name_in(accessor, "type");
    return name == "SCALAR" ? 1u
           : name == "VEC2" ? 2u
           : name == "VEC3" ? 3u
           : name == "VEC4" ? 4u
                            : 0u;
}

/// Consistency of the decoded mesh with the accessor that describes one of its attributes.
std::string add_attribute(Json& root, Resources& resources, const draco::Mesh& mesh,
                          const std::string& semantic, const Json& id, Json& primitive) {
    const auto accessor_index = whole_in(primitive["attributes"], semantic.c_str());
    if (!id.is_number_unsigned() || id.get<std::uint64_t>() > 0xffffffffu || !accessor_index ||
        !root.contains("accessors") || *accessor_index >= root["accessors"].size()) {
        return "attribute " + in_quotes(semantic) + " has no valid id and accessor";
    }
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id.get<std::uint32_t>());
    const Json accessor = root["accessors"][*accessor_index];
    const std::uint32_t components = component_count(accessor);
    if (!attribute || components == 0 || attribute->num_components() != components) {
        return "attribute " + in_quotes(semantic) + " is not in the compressed data as declared";
    }
    const std::uint32_t points = mesh.num_points();
    if (whole_in(accessor, "count") != points) {
        return "attribute " + in_quotes(semantic) + " has " + std::to_string(points) +
               " decoded values, its accessor says otherwise";
    }
    for (std::uint32_t i = 0; i < points; ++i) {
        if (attribute->mapped_index(draco::PointIndex(i)).value() >= attribute->size()) {
            return "attribute " + in_quotes(semantic) + " refers past its values";
        }
    }
    std::vector<std::byte> bytes;
    if (!attribute_bytes(*attribute, points, whole_in(accessor, "componentType").value_or(0),
                         components, bytes)) {
        return "attribute " + in_quotes(semantic) + " cannot be converted to its component type";
    }
    primitive["attributes"][semantic] = add_accessor(root, resources, std::move(bytes), accessor);
    return "";
}

std::size_t add_indices(Json& root, Resources& resources, const draco::Mesh& mesh) {
    std::vector<std::byte> bytes(std::size_t{mesh.num_faces()} * 12);
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
        const auto& face = mesh.face(draco::FaceIndex(f));
        const std::uint32_t corner[3] = {face[0].value(), face[1].value(), face[2].value()};
        std::memcpy(bytes.data() + std::size_t{f} * 12, corner, 12);
    }
    return add_accessor(root, resources, std::move(bytes),
                        {{"componentType", 5125u},
                         {"count", std::size_t{mesh.num_faces()} * 3},
                         {"type", "SCALAR"}});
}

/// Empty, or what is wrong.
std::string decode_primitive(Json& root, Resources& resources, const Json& extension,
                             Json& primitive) {
    const Json* ids = find_member(extension, "attributes");
    const auto bytes = compressed_bytes(root, extension, resources);
    const Json* attributes = find_member(primitive, "attributes");
    if (!bytes || !ids || !ids->is_object() || !attributes || !attributes->is_object()) {
        return "its bufferView or attributes are missing or out of range";
    }
    if (std::string fault = header_fault(*bytes); !fault.empty()) return fault;
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
        return "the compressed data is damaged: " + in_quotes(decoded.status().error_msg_string());
    }
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    if (!mesh || mesh->num_faces() == 0 || mesh->num_points() == 0) {
        return "the compressed data holds no triangles";
    }
    for (const auto& [semantic, id] : ids->items()) {
        if (std::string fault = add_attribute(root, resources, *mesh, semantic, id, primitive);
            !fault.empty()) {
            return fault;
        }
    }
    primitive["indices"] = add_indices(root, resources, *mesh);
    primitive["mode"] = 4u;  // decoded strips are triangle lists
    primitive["extensions"].erase(kDraco);
    return "";
}

}  // namespace

void decode_draco_primitives(nlohmann::json& root, Resources& resources, Report& report) {
    const Json* meshes = find_member(root, "meshes");
    if (!meshes) return;
    for (std::size_t m = 0; m < meshes->size(); ++m) {
        // `root` grows below, so nothing may hold on to a part of it meanwhile.
        const Json* primitives = find_member(root["meshes"][m], "primitives");
        const std::size_t count = primitives ? primitives->size() : 0;
        for (std::size_t p = 0; p < count; ++p) {
            Json primitive = root["meshes"][m]["primitives"][p];
            const Json* found = find_extension(primitive, kDraco);
            if (!found) continue;
            const Json extension = *found;
            const std::string fault = decode_primitive(root, resources, extension, primitive);
            if (!fault.empty()) {
                report.error("mesh " + std::to_string(m) + " > primitive " + std::to_string(p) +
                                 " > " + kDraco,
                             fault, kDracoRemedy);
                continue;
            }
            root["meshes"][m]["primitives"][p] = std::move(primitive);
        }
    }
}

}  // namespace opaline::formats::gltf
