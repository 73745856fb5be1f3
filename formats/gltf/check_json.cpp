#include "formats/gltf/check_json.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kMaxIndex = 0x7ffffffe;   // what an int can hold
constexpr std::uint64_t kMaxOffset = 1ull << 40;  // past any file we read

constexpr std::array<std::string_view, 16> kRequirable = {
    "KHR_mesh_quantization",        "KHR_texture_transform",
    "KHR_draco_mesh_compression",   "EXT_meshopt_compression",
    "KHR_materials_volume",         "KHR_materials_scatter",
    "KHR_materials_volume_scatter", "KHR_materials_diffuse_transmission",
    "KHR_materials_transmission",   "KHR_materials_ior",
    "KHR_materials_specular",       "KHR_materials_emissive_strength",
    "KHR_lights_punctual",          "KHR_materials_pbrSpecularGlossiness",
    "EXT_mesh_gpu_instancing",      "OPALINE_media"};

void check_version(const Json& root, Report& report) {
    const Json* asset = find_member(root, "asset");
    const Json* version = asset ? find_member(*asset, "version") : nullptr;
    if (!version || !version->is_string()) {
        report.error("asset", "asset.version is missing, expected \"2.0\"", "export as glTF 2.0");
        return;
    }
    const auto& text = version->get_ref<const std::string&>();
    if (!text.starts_with("2.")) {
        report.error("asset", "asset.version is " + in_quotes(text) + ", expected 2.x",
                     "export as glTF 2.0");
    }
    const Json* minimum = find_member(*asset, "minVersion");
    if (minimum && *minimum != "2.0") {
        report.error("asset", "asset.minVersion asks for a reader newer than 2.0",
                     "export as glTF 2.0");
    }
}

void check_required_extensions(const Json& root, Report& report) {
    const Json* required = find_member(root, "extensionsRequired");
    if (!required) return;
    if (!required->is_array()) {
        report.error("extensionsRequired", "it is not an array", "");
        return;
    }
    for (const Json& entry : *required) {
        if (!entry.is_string()) {
            report.error("extensionsRequired", "it has an entry that is not a string", "");
            continue;
        }
        const auto& name = entry.get_ref<const std::string&>();
        if (std::find(kRequirable.begin(), kRequirable.end(), name) == kRequirable.end()) {
            report.error(
                "extensionsRequired",
                "the file requires " + in_quotes(name) + ", which Opaline does not support",
                "export without it");
        }
    }
}

bool is_index_key(std::string_view key) {
    constexpr std::array<std::string_view, 14> kKeys = {
        "bufferView", "buffer", "componentType", "count",   "indices", "material", "mode",
        "mesh",       "skin",   "camera",        "sampler", "source",  "texCoord", "scene"};
    return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

bool is_byte_key(std::string_view key) {
    return key == "byteOffset" || key == "byteLength" || key == "byteStride";
}

void check_whole(const Json& value, std::uint64_t limit, const std::string& where,
                 std::string_view key, Report& report) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > limit) {
        report.error(
            where,
            std::string(key) + " is " +
                in_quotes(value.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 40)) +
                ", expected a whole number from 0 to " + std::to_string(limit));
    }
}

/// Morph targets: each an object of semantics and accessors.
void check_targets(const Json& targets, const std::string& where, Report& report) {
    if (!is_array_of(targets, &Json::is_object)) {
        report.error(where, "targets is not an array of objects");
        return;
    }
    for (const Json& target : targets) {
        for (const auto& [name, accessor] : target.items()) {
            check_whole(accessor, kMaxIndex, where, "morph target " + in_quotes(name), report);
        }
    }
}

/// Recursion is bounded by kMaxJsonDepth.
void check_indices(const Json& value, const std::string& where, Report& report) {
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (value[i].is_structured()) {
                check_indices(value[i], where + "[" + std::to_string(i) + "]", report);
            }
        }
        return;
    }
    for (const auto& [key, member] : value.items()) {
        if (key == "extras" || key == "extensions") {
            continue;  // extensions are checked where they are used
        }
        if (key == "attributes" && member.is_object()) {
            for (const auto& [name, accessor] : member.items()) {
                check_whole(accessor, kMaxIndex, where, "attribute " + in_quotes(name), report);
            }
        } else if (key == "targets" && where.starts_with("meshes")) {
            check_targets(member, where, report);
        } else if (key == "weights") {
            if (!is_array_of(member, &Json::is_number)) {
                report.error(where, "weights is not an array of numbers");
            }
        } else if (key == "indices" && member.is_object()) {
            check_indices(member, where + ".sparse.indices", report);
        } else if (is_index_key(key) || (key == "index" && where.starts_with("materials"))) {
            check_whole(member, kMaxIndex, where, key, report);
        } else if (is_byte_key(key)) {
            check_whole(member, kMaxOffset, where, key, report);
        } else if ((key == "children" && where.starts_with("nodes")) ||
                   (key == "nodes" && where.starts_with("scenes"))) {
            if (!member.is_array()) {
                report.error(where, key + " is not an array", "");
                continue;
            }
            for (const Json& index : member) {
                check_whole(index, kMaxIndex, where, key, report);
            }
        } else if (member.is_structured()) {
            check_indices(member, where.empty() ? key : where + "." + key, report);
        }
    }
}

void check_number_array(const Json& object, const char* key, std::size_t length,
                        const std::string& where, Report& report) {
    const Json* found = find_member(object, key);
    if (found && !is_array_of(*found, &Json::is_number, length)) {
        report.error(
            where, std::string(key) + " is not an array of " + std::to_string(length) + " numbers");
    }
}

}  // namespace

bool within_json_bounds(std::string_view text, Report& report) {
    if (text.size() > kMaxJsonBytes) {
        report.over_limit("JSON",
                          "it has " + std::to_string(text.size()) + " bytes, the limit is " +
                              std::to_string(kMaxJsonBytes),
                          "store the data in a .bin file or as .glb");
        return false;
    }
    int depth = 0;
    std::size_t values = 1, objects = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') {
                ++i;
            } else if (c == '"') {
                in_string = false;
            }
            continue;
        }
        if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            ++values;
            objects += c == '{' ? 1 : 0;
            if (++depth > kMaxJsonDepth) {
                report.error("JSON", "it nests deeper than " + std::to_string(kMaxJsonDepth) +
                                         " levels at byte " + std::to_string(i));
                return false;
            }
        } else if (c == ']' || c == '}') {
            --depth;
        } else if (c == ',') {
            ++values;
        }
    }
    if (values > kMaxJsonValues || objects > kMaxJsonObjects) {
        report.over_limit("JSON",
                          "it has more than " + std::to_string(kMaxJsonValues) + " values or " +
                              std::to_string(kMaxJsonObjects) + " objects",
                          "split the asset");
        return false;
    }
    return true;
}

std::optional<nlohmann::json> parse_checked_json(std::string_view text, Report& report) {
    if (!within_json_bounds(text, report)) return std::nullopt;
    Json root;
    try {
        root = Json::parse(text);
    } catch (const Json::exception& problem) {
        return report.fail("JSON", "it cannot be parsed " + json_fault(problem.what()));
    }
    if (!root.is_object()) {
        return report.fail("JSON", "the outermost value is not an object",
                           "give a .gltf or .glb file");
    }
    check_version(root, report);
    check_required_extensions(root, report);
    if (report.failed()) return std::nullopt;
    return root;
}

void check_member_types(const nlohmann::json& root, Report& report) {
    constexpr std::array<const char*, 12> kArrays = {
        "accessors", "animations", "buffers",  "bufferViews", "images", "materials",
        "meshes",    "nodes",      "samplers", "scenes",      "skins",  "textures"};
    for (const char* name : kArrays) {
        const Json* found = find_member(root, name);
        if (found && !is_array_of(*found, &Json::is_object)) {
            report.error(name, "it is not an array of objects");
        }
    }
    if (report.failed()) return;
    check_indices(root, "", report);
    if (const auto nodes = root.find("nodes"); nodes != root.end()) {
        for (std::size_t i = 0; i < nodes->size(); ++i) {
            const std::string where = "node " + std::to_string(i);
            check_number_array((*nodes)[i], "matrix", 16, where, report);
            check_number_array((*nodes)[i], "translation", 3, where, report);
            check_number_array((*nodes)[i], "rotation", 4, where, report);
            check_number_array((*nodes)[i], "scale", 3, where, report);
        }
    }
}

}  // namespace opaline::formats::gltf
