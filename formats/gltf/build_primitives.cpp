#include "formats/gltf/build_primitives.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <utility>

#include "formats/gltf/choose_origin.h"
#include "formats/gltf/complete_normals.h"
#include "formats/gltf/find_originals.h"
#include "formats/gltf/placement.h"
#include "formats/gltf/read_primitive.h"
#include "formats/gltf/tangents.h"

namespace opaline::formats::gltf {

namespace {

bool is_finite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::dvec3 triple(const std::vector<float>& values, std::size_t i) {
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

/// Rows are the cross products of the columns: det(m) * inverse(transpose(m)), which transforms
/// normals and needs no division, so that flattened nodes cause none by zero.
glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

// [m] from the scene's origin: volumes of bodies are finite in single precision, and rays are
// traced (Embree takes none that starts beyond 1.8e18).
constexpr float kFarthest = 1e12f;

bool is_near(glm::vec3 p) {
    return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

void place_positions(const PrimitiveData& data, const Placement& placement, double metres_per_unit,
                     glm::dvec3 origin, Primitive& out, Report& report) {
    const std::size_t count = data.position.size() / 3;
    out.position.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 p =
            metres_per_unit *
            glm::dvec3(placement.at(i) * glm::dvec4(triple(data.position, i), 1.0));
        out.position[i] = glm::vec3(p - origin);
        if (!is_finite(glm::dvec3(glm::vec3(p))) || !is_near(out.position[i])) {
            report.error(out.name,
                         "vertex " + std::to_string(i) + " is too far away for single precision",
                         "scale the scene down");
            return;
        }
    }
}

/// Leaves {0,0,0} where the file gives no direction. Sets nothing if there is no NORMAL.
void place_normals(const PrimitiveData& data, const Placement& placement, Primitive& out) {
    const auto turn = [](const glm::dmat4& world) {
        const glm::dmat3 linear(world);
        return (glm::determinant(linear) < 0.0 ? -1.0 : 1.0) * cofactors(linear);
    };
    const glm::dmat3 by_node = turn(placement.world);
    const std::size_t count = data.normal.size() / 3;
    out.normal.assign(count, glm::vec3(0.0f));
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 stored = triple(data.normal, i);
        // A file may hold a vector of any length; only one without a direction is a fault.
        const double stored_length = glm::length(stored);
        if (!std::isfinite(stored_length) || !(stored_length > 1e-6)) continue;
        const glm::dvec3 n = (placement.skinned.empty() ? by_node : turn(placement.at(i))) *
                             (stored / stored_length);
        const double length = glm::length(n);
        if (std::isfinite(length) && length > 0.0) {
            out.normal[i] = glm::vec3(n / length);
        }
    }
}

void place_texcoords(const PrimitiveData& data, const Material& material, Primitive& out,
                     Report& report) {
    const bool has_image = material.base_color_image != kNone || material.gloss.image != kNone ||
                           material.emission_image != kNone || material.normal_image != kNone ||
                           (material.medium && material.medium->variation);
    if (data.texcoord.empty() && has_image) {
        report.warn(out.name,
                    "its material has a texture, but TEXCOORD_" +
                        std::to_string(material.base_color_texcoord) +
                        " is missing: the texture is not used here",
                    "unwrap the mesh before export");
        return;
    }
    std::size_t bad = 0;
    out.texcoord.resize(data.texcoord.size() / 2);
    for (std::size_t i = 0; i < out.texcoord.size(); ++i) {
        glm::vec2 uv = glm::vec2(material.base_color_uv_transform *
                                 glm::vec3(data.texcoord[2 * i], data.texcoord[2 * i + 1], 1.0f));
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
            uv = glm::vec2(0.0f);
            ++bad;
        }
        out.texcoord[i] = uv;
    }
    if (bad > 0 && has_image) {
        report.warn(
            out.name,
            std::to_string(bad) + " texture coordinates are not finite and are taken as (0, 0)",
            "repair the mesh before export");
    }
}

// Whether u and v grow where they did: TANGENT belongs to coordinates before their transform.
bool keeps_axes(const glm::mat3& transform) {
    return transform[0][0] > 0 && transform[1][1] > 0 && transform[0][1] == 0 &&
           transform[1][0] == 0;
}

void place_colors(const PrimitiveData& data, const Material& material, Primitive& out,
                  Report& report) {
    const std::size_t stride = data.color_components;
    std::size_t bad = 0;
    const auto reflectance = [&](float c) {
        if (c >= 0.0f && c <= 1.0f) return c;
        ++bad;
        return c > 1.0f ? 1.0f : 0.0f;  // NaN becomes 0
    };
    out.color.resize(data.color.size() / stride);
    for (std::size_t i = 0; i < out.color.size(); ++i) {
        const float* c = data.color.data() + i * stride;
        out.color[i] = {reflectance(c[0]), reflectance(c[1]), reflectance(c[2])};
    }
    if (stride == 4 && material.alpha_mode != Material::AlphaMode::opaque) {
        out.alpha.resize(out.color.size());
        for (std::size_t i = 0; i < out.alpha.size(); ++i) {
            out.alpha[i] = reflectance(data.color[i * stride + 3]);
        }
    }
    if (bad > 0) {
        report.warn(out.name,
                    std::to_string(bad) + " values of COLOR_0 were outside [0, 1] and are clamped",
                    "a surface cannot reflect more light than it receives");
    }
}

// True if the triangle whose corners begin at index `t` has no area.
bool is_flat(const Primitive& primitive, std::size_t t) {
    const glm::dvec3 a(primitive.position[primitive.index[t]]);
    const glm::dvec3 b(primitive.position[primitive.index[t + 1]]);
    const glm::dvec3 c(primitive.position[primitive.index[t + 2]]);
    return glm::cross(b - a, c - a) == glm::dvec3(0.0);
}

void place_indices(const PrimitiveData& data, bool mirrored, Primitive& out, Report& report) {
    out.index = data.index;
    std::size_t flat = 0;
    for (std::size_t t = 0; t + 2 < out.index.size(); t += 3) {
        if (mirrored) {
            std::swap(out.index[t + 1], out.index[t + 2]);
        }
        flat += is_flat(out, t) ? 1 : 0;
    }
    if (flat > 0) {
        report.warn(out.name, std::to_string(flat) + " of " + std::to_string(out.index.size() / 3) +
                                  " triangles have no area; they block no light");
    }
}

// The data of the mesh that was read last: instances of one mesh mostly follow one another. What a
// report was made of is read again, so that each instance is named.
class LastMesh {
  public:
    LastMesh(const Document& document, const std::vector<Bytes>& buffers)
        : document_(document), buffers_(buffers) {}

    // Null where the primitive is at fault. Valid until the next call.
    const PrimitiveData* read(const MeshPrimitive& primitive, const WantedData& wanted,
                              const std::string& where, Report& report) {
        const Key key{&primitive, wanted.morph_weights, wanted.joints};
        const auto found = std::ranges::find(known_, key, &Known::key);
        if (found != known_.end()) return &found->data;
        const std::size_t said = count_said(report);
        auto data = read_primitive(document_, buffers_, primitive, wanted, where, report);
        if (!data) return nullptr;
        if (said != count_said(report)) {
            reported_ = std::move(*data);
            return &reported_;
        }
        return &known_.emplace_back(Known{key, std::move(*data)}).data;
    }

    // Keeps the primitives of one mesh alone.
    void begin(std::uint32_t mesh) {
        if (mesh != mesh_) known_.clear();
        mesh_ = mesh;
    }

  private:
    struct Key {
        const MeshPrimitive* primitive = nullptr;
        std::vector<double> morph_weights;
        bool joints = false;
        bool operator==(const Key&) const = default;
    };
    struct Known {
        Key key;
        PrimitiveData data;
    };

    static std::size_t count_said(const Report& report) {
        return report.errors.size() + report.errors_left_out + report.warnings.size() +
               report.warnings_left_out + report.notes.size();
    }

    const Document& document_;
    const std::vector<Bytes>& buffers_;
    std::uint32_t mesh_ = kNone;
    std::deque<Known> known_;
    PrimitiveData reported_;
};

// An instance that `original`, built before, only has to be moved for, from its `first` primitive
// on. False: it would stand too far away.
bool copy_primitives(const MeshInstance& instance, const MeshInstance& original, std::size_t first,
                     std::size_t count, double metres_per_unit, const std::string& name,
                     Scene& scene) {
    const glm::vec3 offset(metres_per_unit * glm::dvec3(instance.world[3] - original.world[3]));
    for (std::size_t p = first; p < first + count; ++p) {
        for (const glm::vec3& at : scene.primitives[p].position) {
            if (!is_near(at + offset)) return false;
        }
    }
    for (std::size_t p = first; p < first + count; ++p) {
        Primitive copy;
        copy.node = instance.node;
        copy.mesh = scene.primitives[p].mesh;
        copy.primitive = scene.primitives[p].primitive;
        copy.name = name + std::to_string(copy.primitive);
        copy.material = scene.primitives[p].material;
        if (!scene.primitives[p].index.empty()) {
            copy.copy = {static_cast<std::uint32_t>(p), offset};
        }
        scene.primitives.push_back(std::move(copy));
    }
    return true;
}

}  // namespace

bool has_area(const Primitive& primitive) {
    for (std::size_t t = 0; t + 2 < primitive.index.size(); t += 3) {
        if (!is_flat(primitive, t)) return true;
    }
    return false;
}

void build_primitives(const Document& document, const std::vector<MeshInstance>& instances,
                      const std::vector<Bytes>& buffers, const PrimitiveOptions& options,
                      Scene& scene, Report& report) {
    const double metres_per_unit = options.metres_per_unit;
    scene.origin = choose_origin(document, instances, buffers, metres_per_unit);
    ComputedNormals computed;
    LastMesh meshes(document, buffers);
    const std::vector<std::size_t> original =
        options.keep_copies ? find_originals(document, instances) : std::vector<std::size_t>();
    std::vector<std::size_t> first_of(instances.size());  // primitive of each instance
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const MeshInstance& instance = instances[i];
        const Node& node = document.nodes[instance.node];
        const std::uint32_t mesh_index = node.mesh;
        const Mesh& mesh = document.meshes[mesh_index];
        meshes.begin(mesh_index);
        const std::size_t first = first_of[i] = scene.primitives.size();
        const std::string name =
            label("node", instance.node, node.name) +
            (instance.copy == kNone ? "" : " > instance " + std::to_string(instance.copy)) +
            " > mesh " + std::to_string(mesh_index) + " > primitive ";
        if (!original.empty() && original[i] != i && !report.failed() &&
            copy_primitives(instance, instances[original[i]], first_of[original[i]],
                            mesh.primitives.size(), metres_per_unit, name, scene)) {
            continue;
        }
        for (std::uint32_t p = 0; p < mesh.primitives.size(); ++p) {
            const MeshPrimitive& source = mesh.primitives[p];
            Primitive& out = scene.primitives.emplace_back();
            out.node = instance.node;
            out.mesh = mesh_index;
            out.primitive = p;
            out.name = name + std::to_string(p);
            out.material = source.material == kNone
                               ? static_cast<std::uint32_t>(scene.materials.size() - 1)
                               : source.material;
            if (source.mode < Mode::triangles) {
                report.warn(out.name, "points and lines are not simulated: it is kept empty");
                continue;
            }
            const Material& material = scene.materials[out.material];
            // Kept without a texture, too: a media file may bring one.
            const bool has_normal_map = material.normal_image != kNone;
            const PrimitiveData* const data =
                meshes.read(source,
                            {.texcoord_set = material.base_color_texcoord,
                             .tangents = has_normal_map,
                             .joints = !instance.joints.empty(),
                             .morph_weights = node.weights.empty() ? mesh.weights : node.weights},
                            out.name, report);
            if (data == nullptr) continue;
            const Placement placement = place_primitive(instance, *data, out.name, report);
            place_positions(*data, placement, metres_per_unit, scene.origin, out, report);
            place_normals(*data, placement, out);
            place_texcoords(*data, material, out, report);
            // The specification ignores tangents without normals.
            if (has_normal_map && !data->normal.empty() &&
                keeps_axes(material.base_color_uv_transform)) {
                out.tangent = turn_tangents(data->tangent, placement);
            }
            place_colors(*data, material, out, report);
            place_indices(*data, placement.is_mirrored, out, report);
            warn_of_coarse_positions(*data, out, scene.origin, report);
        }
        if (!report.failed()) {
            const auto made = std::span(scene.primitives).subspan(first);
            complete_normals(made, options.smooth_angle, computed, report);
            for (Primitive& primitive : made) {
                if (scene.materials[primitive.material].normal_image != kNone &&
                    !primitive.texcoord.empty()) {
                    complete_tangents(primitive);
                }
            }
        }
    }
    tell_of_normals(computed, options.smooth_angle, report);
}

}  // namespace opaline::formats::gltf
