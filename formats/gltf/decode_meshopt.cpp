#include "formats/gltf/decode_meshopt.h"

#include <meshoptimizer.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;
constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kMeshoptRemedy =
    "export again, or decompress with gltfpack -noq or gltf-transform";

/// The extension object of one buffer view; its ranges checked against what the decoders demand
/// (the library asserts on them) and against the worst ratio that its formats can reach.
struct Compressed {
    Bytes bytes;
    std::uint64_t stride = 0, count = 0;
    std::string mode, filter;
};

/// Empty where the description is sound.
std::string read_description(const Json& extension, const std::vector<Bytes>& buffers,
                             Compressed& out) {
    if (!extension.is_object()) return "it is not an object";
    const auto buffer = whole_in(extension, "buffer"), length = whole_in(extension, "byteLength"),
               stride = whole_in(extension, "byteStride"), count = whole_in(extension, "count"),
               offset = extension.contains("byteOffset") ? whole_in(extension, "byteOffset")
                                                         : std::optional<std::uint64_t>(0);
    if (!buffer || !offset || !length || !stride || !count) {
        return "buffer, byteOffset, byteLength, byteStride or count is missing or no whole number";
    }
    if (*buffer >= buffers.size() || *offset > buffers[*buffer].size() ||
        *length > buffers[*buffer].size() - *offset) {
        return "its bytes lie outside its buffer";
    }
    out.bytes = buffers[*buffer].subspan(*offset, *length);
    out.stride = *stride;
    out.count = *count;
    out.mode = name_in(extension, "mode");
    out.filter = name_in(extension, "filter");
    if (out.count == 0 || out.count > kMaxTotalBytes) {
        return "count is " + std::to_string(out.count);
    }
    if (out.mode == "ATTRIBUTES") {
        if (out.stride == 0 || out.stride > 256 || out.stride % 4 != 0) {
            return "byteStride is " + std::to_string(out.stride) + ", expected 4, 8 ... 256";
        }
        // Two header bits stand for at least 16 bytes: 64 decoded bytes for one.
        if (out.count * out.stride / 64 > out.bytes.size() + 1024) {
            return "count is too large for its compressed bytes";
        }
        const bool sound = out.filter.empty() || out.filter == "NONE" ||
                           (out.filter == "OCTAHEDRAL" && (out.stride == 4 || out.stride == 8)) ||
                           (out.filter == "QUATERNION" && out.stride == 8) ||
                           out.filter == "EXPONENTIAL";
        return sound ? "" : "filter " + in_quotes(out.filter) + " does not go with its byteStride";
    }
    if (out.mode != "TRIANGLES" && out.mode != "INDICES") {
        return "mode is " + in_quotes(out.mode) + ", expected ATTRIBUTES, TRIANGLES or INDICES";
    }
    if (out.stride != 2 && out.stride != 4) {
        return "byteStride is " + std::to_string(out.stride) + ", expected 2 or 4";
    }
    if (out.mode == "TRIANGLES" && out.count % 3 != 0) {
        return "count is " + std::to_string(out.count) + ", expected a multiple of 3";
    }
    // At least one byte a triangle, or one an index.
    if (out.count / 3 > out.bytes.size()) return "count is too large for its compressed bytes";
    return "";
}

bool decode(const Compressed& in, std::vector<std::byte>& out) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(in.bytes.data());
    if (in.mode == "TRIANGLES") {
        return meshopt_decodeIndexBuffer(out.data(), in.count, in.stride, bytes, in.bytes.size()) ==
               0;
    }
    if (in.mode == "INDICES") {
        return meshopt_decodeIndexSequence(out.data(), in.count, in.stride, bytes,
                                           in.bytes.size()) == 0;
    }
    if (meshopt_decodeVertexBuffer(out.data(), in.count, in.stride, bytes, in.bytes.size()) != 0) {
        return false;
    }
    if (in.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(out.data(), in.count, in.stride);
    } else if (in.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(out.data(), in.count, in.stride);
    } else if (in.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(out.data(), in.count, in.stride);
    }
    return true;
}

}  // namespace

void decode_meshopt_views(nlohmann::json& root, Resources& resources, Report& report) {
    const auto views = root.find("bufferViews");
    if (views == root.end()) return;
    for (std::size_t i = 0; i < views->size(); ++i) {
        Json& view = (*views)[i];
        const Json* extension = find_extension(view, kMeshopt);
        if (!extension) continue;
        const std::string where = "bufferView " + std::to_string(i) + " > " + kMeshopt;
        Compressed compressed;
        const std::string fault = read_description(*extension, resources.buffers, compressed);
        if (!fault.empty()) {
            report.error(where, fault, kMeshoptRemedy);
            continue;
        }
        const std::uint64_t size = compressed.count * compressed.stride;
        if (resources.bytes_held + size > kMaxTotalBytes) {
            report.over_limit(
                where,
                "the decoded data passes the limit of " + std::to_string(kMaxTotalBytes) + " bytes",
                "split the asset");
            return;
        }
        std::vector<std::byte> decoded(size);
        if (!decode(compressed, decoded)) {
            report.error(where, "the compressed data is damaged", kMeshoptRemedy);
            continue;
        }
        view["buffer"] = resources.buffers.size();
        view["byteOffset"] = 0u;
        view["byteLength"] = size;
        view["extensions"].erase(kMeshopt);
        resources.buffers.push_back(resources.keep(std::move(decoded)));
    }
}

}  // namespace opaline::formats::gltf
