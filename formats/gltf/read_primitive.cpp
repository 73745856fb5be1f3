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
        const auto found = primitive.attributes.find(semantic);
        if (found == primitive.attributes.end()) {
            return {};
        }
        const Accessor& accessor = document.accessors[found->second];
        if (accessor.is_matrix || accessor.components < min_components ||
            accessor.components > max_components || accessor.type == ComponentType::uint32) {
            report.error(where,
                         semantic + " has " + std::to_string(accessor.components) + " x " +
                             name_of(accessor.type) + " per vertex, expected " +
                             std::to_string(min_components) + " numbers",
                         kExportAgain);
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
            report.error(where, semantic + " has a sparse index past its last element",
                         kExportAgain);
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
        reader.report.error(reader.where,
                            std::string("its indices are ") + std::to_string(accessor.components) +
                                " x " + name_of(accessor.type) +
                                ", expected one unsigned whole number each",
                            kExportAgain);
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
        reader.report.error(reader.where, fault, kExportAgain);
        return {};
    }
    return std::move(read.value);
}

/// glTF 2.0 specification, "Topology types": the corners of triangle i of a strip or a fan.
std::vector<std::uint32_t> triangulate(Mode mode, std::vector<std::uint32_t> drawn) {
    if (mode == Mode::triangles) {
        return drawn;
    }
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i + 2 < drawn.size(); ++i) {
        const bool strip = mode == Mode::triangle_strip;
        triangles.push_back(strip ? drawn[i] : drawn[i + 1]);
        triangles.push_back(strip ? drawn[i + 1 + i % 2] : drawn[i + 2]);
        triangles.push_back(strip ? drawn[i + 2 - i % 2] : drawn[0]);
    }
    return triangles;
}

}  // namespace

std::optional<PrimitiveData> read_primitive(const Document& document,
                                            const std::vector<Bytes>& buffers,
                                            const MeshPrimitive& primitive,
                                            std::uint32_t texcoord_set, bool wants_tangents,
                                            const std::string& where, Report& report) {
    const Reader reader{document, buffers, primitive, where, report};
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
        report.error(where, "it has no POSITION attribute", "export the mesh with positions");
        return std::nullopt;
    }
    const std::size_t faults = report.errors.size() + report.errors_left_out;
    const std::uint64_t vertices = document.accessors[position->second].count;

    PrimitiveData data;
    data.position = reader.attribute("POSITION", 3, 3, vertices, kExportAgain);
    data.normal =
        reader.attribute("NORMAL", 3, 3, vertices,
                         "export with one normal per vertex, or drop NORMAL to have it computed");
    if (wants_tangents) {
        data.tangent = reader.attribute("TANGENT", 4, 4, vertices,
                                        "export with one tangent per vertex, or drop TANGENT to "
                                        "have it computed");
    }
    if (texcoord_set != kNone) {
        data.texcoord = reader.attribute("TEXCOORD_" + std::to_string(texcoord_set), 2, 2, vertices,
                                         "export with one coordinate per vertex");
    }
    if (const auto color = primitive.attributes.find("COLOR_0");
        color != primitive.attributes.end()) {
        data.color =
            reader.attribute("COLOR_0", 3, 4, vertices, "export with one colour per vertex");
        data.color_components = document.accessors[color->second].components;
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
    if (report.errors.size() + report.errors_left_out != faults) {
        return std::nullopt;
    }
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
