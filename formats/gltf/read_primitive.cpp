#include "formats/gltf/read_primitive.h"

#include <algorithm>
#include <cmath>

#include "formats/gltf/read_accessor.h"

namespace opaline::formats::gltf {

namespace {

const char* name_of(ComponentType type) {
    switch (type) {
        case ComponentType::int8:
            return "BYTE";
        case ComponentType::uint8:
            return "UNSIGNED_BYTE";
        case ComponentType::int16:
            return "SHORT";
        case ComponentType::uint16:
            return "UNSIGNED_SHORT";
        case ComponentType::uint32:
            return "UNSIGNED_INT";
        case ComponentType::float32:
            return "FLOAT";
    }
    return "?";
}

struct Reader {
    const Document& document;
    const std::vector<Bytes>& buffers;
    const MeshPrimitive& primitive;
    const std::string& where;
    Report& report;

    /// The values of an attribute with one of the allowed shapes and types; empty if it is absent
    /// or at fault. Core glTF and KHR_mesh_quantization types are both allowed.
    std::vector<float> attribute(const std::string& semantic, std::uint32_t min_components,
                                 std::uint32_t max_components, std::uint64_t vertices,
                                 const char* count_remedy) const {
        return values(primitive.attributes, "", semantic, min_components, max_components, vertices,
                      count_remedy);
    }

    /// The same of a morph target, whose messages begin with `prefix`.
    std::vector<float> values(const Attributes& attributes, const std::string& prefix,
                              const std::string& name, std::uint32_t min_components,
                              std::uint32_t max_components, std::uint64_t vertices,
                              const char* count_remedy) const {
        const auto found = attributes.find(name);
        if (found == attributes.end()) {
            return {};
        }
        const std::string semantic = prefix + name;
        const Accessor& accessor = document.accessors[found->second];
        if (accessor.is_matrix || accessor.components < min_components ||
            accessor.components > max_components || accessor.type == ComponentType::uint32) {
            report.error(where, semantic + " has " + std::to_string(accessor.components) + " x " +
                                    name_of(accessor.type) + " per vertex, expected " +
                                    std::to_string(min_components) + " numbers");
            return {};
        }
        if (accessor.count != vertices) {
            report.error(where,
                         semantic + " has " + std::to_string(accessor.count) +
                             " values but POSITION has " + std::to_string(vertices),
                         count_remedy);
            return {};
        }
        auto read = read_floats(document, buffers, found->second);
        if (read.sparse_index_bad) {
            report.error(where, semantic + " has a sparse index past its last element");
            return {};
        }
        return std::move(read.value);
    }
};

/// Indices as stored, or 0, 1, 2 ... ; empty on a fault.
std::vector<std::uint32_t> drawn_vertices(const Reader& reader, std::size_t vertices) {
    const std::uint32_t accessor_index = reader.primitive.indices;
    if (accessor_index == kNone) {
        std::vector<std::uint32_t> drawn(vertices);
        for (std::size_t i = 0; i < vertices; ++i) {
            drawn[i] = static_cast<std::uint32_t>(i);
        }
        return drawn;
    }
    const Accessor& accessor = reader.document.accessors[accessor_index];
    const bool whole = accessor.type == ComponentType::uint8 ||
                       accessor.type == ComponentType::uint16 ||
                       accessor.type == ComponentType::uint32;
    if (!whole || accessor.components != 1 || accessor.normalized) {
        reader.report.error(reader.where, std::string("its indices are ") +
                                              std::to_string(accessor.components) + " x " +
                                              name_of(accessor.type) +
                                              ", expected one unsigned whole number each");
        return {};
    }
    auto read = read_indices(reader.document, reader.buffers, accessor_index);
    const auto bad = std::find_if(read.value.begin(), read.value.end(),
                                  [&](std::uint32_t i) { return i >= vertices; });
    if (bad != read.value.end() || read.sparse_index_bad) {
        const std::string fault = read.sparse_index_bad
                                      ? "its indices have a sparse index past their last element"
                                      : "index " + std::to_string(bad - read.value.begin()) +
                                            " is " + std::to_string(*bad) + ", but there are " +
                                            std::to_string(vertices) + " vertices";
        reader.report.error(reader.where, fault);
        return {};
    }
    return std::move(read.value);
}

/// glTF 2.0 specification, "Topology types": the corners of triangle i of a strip or a fan.
std::vector<std::uint32_t> triangulate(Mode mode, std::vector<std::uint32_t> drawn) {
    if (mode == Mode::triangles) return drawn;
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i + 2 < drawn.size(); ++i) {
        const bool strip = mode == Mode::triangle_strip;
        triangles.push_back(strip ? drawn[i] : drawn[i + 1]);
        triangles.push_back(strip ? drawn[i + 1 + i % 2] : drawn[i + 2]);
        triangles.push_back(strip ? drawn[i + 2 - i % 2] : drawn[0]);
    }
    return triangles;
}

/// glTF 2.0, 3.7.2.2: attribute + sum of weight * target. Of TANGENT, the sign stays.
void add_morph_targets(const Reader& reader, const std::vector<double>& weights,
                       std::uint64_t vertices, PrimitiveData& data) {
    const auto& targets = reader.primitive.targets;
    for (std::size_t t = 0; t < std::min(targets.size(), weights.size()); ++t) {
        const auto weight = static_cast<float>(weights[t]);
        if (weight == 0) continue;
        const std::string prefix = "morph target " + std::to_string(t) + " ";
        const auto add = [&](const char* semantic, std::size_t stride, std::vector<float>& to) {
            if (to.empty()) {
                return;  // not in the file, not wanted, or at fault
            }
            const std::vector<float> moved = reader.values(
                targets[t], prefix, semantic, 3, 3, vertices, "export with one value per vertex");
            for (std::size_t i = 0; i < moved.size(); ++i) {
                to[i / 3 * stride + i % 3] += weight * moved[i];
            }
        };
        add("POSITION", 3, data.position);
        add("NORMAL", 3, data.normal);
        add("TANGENT", 4, data.tangent);
    }
}

/// JOINTS_n and WEIGHTS_n for n = 0, 1, ...
void read_joints(const Reader& reader, std::uint64_t vertices, PrimitiveData& data) {
    std::vector<std::vector<float>> joints, weights;
    for (std::size_t set = 0;; ++set) {
        const std::string n = std::to_string(set);
        const auto& attributes = reader.primitive.attributes;
        const bool has_joints = attributes.contains("JOINTS_" + n);
        const bool has_weights = attributes.contains("WEIGHTS_" + n);
        if (has_joints != has_weights) {
            reader.report.error(reader.where,
                                "it has only one of JOINTS_" + n + " and WEIGHTS_" + n);
            return;
        }
        if (!has_joints) break;
        constexpr const char* kRemedy = "export with one value per vertex";
        joints.push_back(reader.attribute("JOINTS_" + n, 4, 4, vertices, kRemedy));
        weights.push_back(reader.attribute("WEIGHTS_" + n, 4, 4, vertices, kRemedy));
        const Accessor& joint = reader.document.accessors[attributes.at("JOINTS_" + n)];
        if ((joint.type != ComponentType::uint8 && joint.type != ComponentType::uint16) ||
            joint.normalized) {
            reader.report.error(reader.where, "JOINTS_" + n + " has " + name_of(joint.type) +
                                                  ", expected UNSIGNED_BYTE or UNSIGNED_SHORT");
        }
        if (joints.back().empty() || weights.back().empty()) {
            return;  // at fault
        }
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        for (std::size_t set = 0; set < joints.size(); ++set) {
            const auto from = static_cast<std::ptrdiff_t>(4 * v);
            data.joint.insert(data.joint.end(), joints[set].begin() + from,
                              joints[set].begin() + from + 4);
            data.weight.insert(data.weight.end(), weights[set].begin() + from,
                               weights[set].begin() + from + 4);
        }
    }
}

}  // namespace

std::optional<PrimitiveData> read_primitive(const Document& document,
                                            const std::vector<Bytes>& buffers,
                                            const MeshPrimitive& primitive,
                                            const WantedData& wanted, const std::string& where,
                                            Report& report) {
    const Reader reader{document, buffers, primitive, where, report};
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
        return report.fail(where, "it has no POSITION attribute", "export the mesh with positions");
    }
    const std::size_t faults = report.error_count();
    const std::uint64_t vertices = document.accessors[position->second].count;

    PrimitiveData data;
    data.position = reader.attribute("POSITION", 3, 3, vertices, kExportAgain);
    data.normal =
        reader.attribute("NORMAL", 3, 3, vertices,
                         "export with one normal per vertex, or drop NORMAL to have it computed");
    if (wanted.tangents) {
        data.tangent = reader.attribute("TANGENT", 4, 4, vertices,
                                        "export with one tangent per vertex, or drop TANGENT to "
                                        "have it computed");
    }
    if (wanted.texcoord_set != kNone) {
        data.texcoord = reader.attribute("TEXCOORD_" + std::to_string(wanted.texcoord_set), 2, 2,
                                         vertices, "export with one coordinate per vertex");
    }
    if (const auto color = primitive.attributes.find("COLOR_0");
        color != primitive.attributes.end()) {
        data.color =
            reader.attribute("COLOR_0", 3, 4, vertices, "export with one colour per vertex");
        data.color_components = document.accessors[color->second].components;
    }
    add_morph_targets(reader, wanted.morph_weights, vertices, data);
    if (wanted.joints) {
        read_joints(reader, vertices, data);
    }
    const auto bad = std::find_if(data.position.begin(), data.position.end(),
                                  [](float x) { return !std::isfinite(x); });
    if (bad != data.position.end()) {
        report.error(where,
                     "POSITION of vertex " + std::to_string((bad - data.position.begin()) / 3) +
                         " is not finite",
                     "repair the mesh before export");
    }
    auto drawn = drawn_vertices(reader, vertices);
    if (report.error_count() != faults) return std::nullopt;
    if (primitive.mode == Mode::triangles && drawn.size() % 3 != 0) {
        report.warn(where, std::to_string(drawn.size()) +
                               " corners are no multiple of 3: the last " +
                               std::to_string(drawn.size() % 3) + " are ignored");
        drawn.resize(drawn.size() - drawn.size() % 3);
    }
    data.index = triangulate(primitive.mode, std::move(drawn));
    return data;
}

}  // namespace opaline::formats::gltf
