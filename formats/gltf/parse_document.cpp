#include "formats/gltf/parse_document.h"

#include <fstream>  // tiny_gltf.h uses it even where TINYGLTF_NO_FS leaves it out

// Debian's libdraco exports a tinygltf of its own with other struct layouts, and the dynamic linker
// may choose either. So ours is compiled here, under a name of its own, and reads no file or image.
#define tinygltf opaline_tinygltf
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "formats/gltf/instances.h"
#include "formats/gltf/read_lights.h"
#include "formats/gltf/read_material.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

std::uint32_t link(int index) {
    return index < 0 ? kNone : static_cast<std::uint32_t>(index);
}

/// tinygltf refuses index accessors without a buffer view, which glTF allows. One more view at the
/// end stands for "none" on the way through it. Returns that view's index.
int give_every_accessor_a_view(Json& root) {
    Json& views = root["bufferViews"];
    if (!views.is_array()) {
        views = Json::array();
    }
    const int none = static_cast<int>(views.size());
    views.push_back({{"buffer", 0}, {"byteLength", 1}});
    if (const auto accessors = root.find("accessors"); accessors != root.end()) {
        for (Json& accessor : *accessors) {
            if (!accessor.contains("bufferView")) {
                accessor["bufferView"] = none;
            }
        }
    }
    return none;
}

/// Applications' own data; nothing of Opaline's. Recursion is bounded by kMaxJsonDepth.
void drop_extras(Json& value) {
    if (value.is_object()) {
        value.erase("extras");
    }
    if (value.is_structured()) {
        for (Json& member : value) {
            drop_extras(member);
        }
    }
}

Accessor convert(const tinygltf::Accessor& in, int no_view) {
    Accessor out;
    out.view = in.bufferView == no_view ? kNone : link(in.bufferView);
    out.offset = in.byteOffset;
    out.count = in.count;
    out.type = static_cast<ComponentType>(in.componentType);
    out.components = static_cast<std::uint32_t>(
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(in.type)));
    out.is_matrix = in.type == TINYGLTF_TYPE_MAT2 || in.type == TINYGLTF_TYPE_MAT3 ||
                    in.type == TINYGLTF_TYPE_MAT4;
    out.normalized = in.normalized;
    if (in.sparse.isSparse) {
        Sparse sparse;
        sparse.count = static_cast<std::uint64_t>(in.sparse.count);
        sparse.index_view = link(in.sparse.indices.bufferView);
        sparse.index_offset = static_cast<std::uint64_t>(in.sparse.indices.byteOffset);
        sparse.index_type = static_cast<ComponentType>(in.sparse.indices.componentType);
        sparse.value_view = link(in.sparse.values.bufferView);
        sparse.value_offset = static_cast<std::uint64_t>(in.sparse.values.byteOffset);
        out.sparse = sparse;
    }
    return out;
}

Mesh convert(const tinygltf::Mesh& in) {
    Mesh out;
    out.name = in.name;
    out.weights = in.weights;
    for (const tinygltf::Primitive& primitive : in.primitives) {
        MeshPrimitive& copy = out.primitives.emplace_back();
        for (const auto& [semantic, accessor] : primitive.attributes) {
            copy.attributes.emplace(semantic, link(accessor));
        }
        copy.indices = link(primitive.indices);
        copy.material = link(primitive.material);
        copy.mode = static_cast<Mode>(primitive.mode);
        for (const auto& target : primitive.targets) {
            Attributes& added = copy.targets.emplace_back();
            for (const auto& [semantic, accessor] : target) {
                added.emplace(semantic, link(accessor));
            }
        }
    }
    return out;
}

/// glTF 2.0 specification, "Transformations": either the column-major matrix or T * R * S.
glm::dmat4 local_transform(const tinygltf::Node& node, const std::string& where, Report& report) {
    glm::dmat4 local(1.0);
    if (node.matrix.size() == 16) {
        local = glm::make_mat4(node.matrix.data());
        const glm::dvec4 last(local[0][3], local[1][3], local[2][3], local[3][3] - 1.0);
        if (!(glm::dot(last, last) < 1e-12)) {
            report.error(where, "the last row of its matrix is not 0 0 0 1",
                         "apply the transform before export");
        }
    } else {
        glm::dvec3 translation(0.0), scale(1.0);
        glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
        if (node.translation.size() == 3) {
            translation = glm::make_vec3(node.translation.data());
        }
        if (node.scale.size() == 3) {
            scale = glm::make_vec3(node.scale.data());
        }
        if (node.rotation.size() == 4) {
            const auto& r = node.rotation;
            rotation = glm::dquat(r[3], r[0], r[1], r[2]);
            const double length = glm::length(rotation);
            if (!(length > 1e-6 && length < 1e6)) {
                report.error(where, "its rotation is not a unit quaternion",
                             "apply the transform before export");
                return local;
            }
            rotation = rotation / length;
        }
        local = glm::mat4_cast(rotation);
        for (int axis = 0; axis < 3; ++axis) {
            local[axis] *= scale[axis];
        }
        local[3] = glm::dvec4(translation, 1.0);
    }
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(local[column][row])) {
                report.error(where, "its transform is not finite",
                             "apply the transform before export");
                return glm::dmat4(1.0);
            }
        }
    }
    return local;
}

void convert(const tinygltf::Node& in, const std::string& where, Node& out, Report& report) {
    out.name = in.name;
    out.mesh = link(in.mesh);
    for (const int child : in.children) {
        out.children.push_back(link(child));
    }
    out.local = local_transform(in, where, report);
    out.skin = link(in.skin);
    out.weights = in.weights;
    out.has_camera = in.camera >= 0;
}

/// Calls `read` with each object of one of the file's arrays.
template <class Read>
void for_each_in(const Json& root, const char* key, const char* kind, Report& report,
                 const Read& read) {
    if (const Json* found = find_member(root, key)) {
        for (std::size_t i = 0; i < found->size(); ++i) {
            const Json& entry = (*found)[i];
            read(NamedObject{entry, label(kind, i, name_in(entry)), report});
        }
    }
}

bool is_index(const Json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() < kNone;
}

std::vector<Skin> read_skins(const Json& root, Report& report) {
    std::vector<Skin> skins;
    const Json* found = find_member(root, "skins");
    if (!found) return skins;
    for (const Json& entry : *found) {
        const std::string where = "skin " + std::to_string(skins.size());
        Skin& skin = skins.emplace_back();
        const Json* joints = find_member(entry, "joints");
        if (!joints || !joints->is_array() || joints->empty() ||
            !std::all_of(joints->begin(), joints->end(), is_index)) {
            report.error(where, "joints is not a list of nodes");
            continue;
        }
        skin.joints = joints->get<std::vector<std::uint32_t>>();
        if (const Json* bind = find_member(entry, "inverseBindMatrices")) {
            if (is_index(*bind)) {
                skin.inverse_bind_matrices = bind->get<std::uint32_t>();
            } else {
                report.error(where, "inverseBindMatrices is not an accessor");
            }
        }
    }
    return skins;
}

std::vector<ImageSource> read_images(const Json& root, Report& report) {
    std::vector<ImageSource> images;
    for_each_in(root, "images", "image", report, [&](const NamedObject& entry) {
        ImageSource& image = images.emplace_back();
        image.name = name_in(entry.object);
        image.uri = name_in(entry.object, "uri");
        image.view = entry.object.value("bufferView", kNone);
        if (image.uri.empty() == (image.view == kNone)) {
            report.error(entry.where, "it needs exactly one of uri and bufferView");
        }
    });
    return images;
}

}  // namespace

std::optional<Document> parse_document(nlohmann::json root, Report& report) {
    Document document;
    document.images = read_images(root, report);
    document.lights = read_lights(root, report);
    document.skins = read_skins(root, report);
    document.has_animations = root.contains("animations") && !root["animations"].empty();
    document.default_scene = root.value("scene", kNone);
    for_each_in(root, "materials", "material", report, [&](const NamedObject& material) {
        document.materials.push_back(read_material(material));
    });
    for_each_in(root, "nodes", "node", report, [&](const NamedObject& node) {
        Node& out = document.nodes.emplace_back();
        out.extensions = node.extensions().keys();
        out.light = read_node_light(node);
        out.instances = read_instances(node);
    });
    // Remove the parts that Opaline reads itself or ignores, so that tinygltf does not parse them.
    for (const char* key : {"buffers", "images", "materials", "animations", "skins", "cameras",
                            "extensions", "extras", "scene"}) {
        root.erase(key);
    }
    drop_extras(root);
    const int no_view = give_every_accessor_a_view(root);
    const std::string text = root.dump(-1, ' ', true, Json::error_handler_t::replace);
    root = nullptr;

    tinygltf::TinyGLTF reader;
    tinygltf::Model model;
    std::string problems, remarks;
    if (!reader.LoadASCIIFromString(&model, &problems, &remarks, text.data(),
                                    static_cast<unsigned int>(text.size()), "", 0)) {
        return report.fail("JSON", "it does not follow the glTF schema: " + in_quotes(problems));
    }
    if (model.bufferViews.size() != static_cast<std::size_t>(no_view) + 1) {
        return report.fail("bufferViews", "they cannot be read");
    }
    model.bufferViews.pop_back();
    for (const auto& view : model.bufferViews) {
        document.views.push_back(
            {link(view.buffer), view.byteOffset, view.byteLength, view.byteStride});
    }
    for (const auto& accessor : model.accessors) {
        document.accessors.push_back(convert(accessor, no_view));
    }
    for (const auto& mesh : model.meshes) {
        document.meshes.push_back(convert(mesh));
    }
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const tinygltf::Node& node = model.nodes[i];
        convert(node, label("node", i, node.name), document.nodes.at(i), report);
    }
    for (const auto& scene : model.scenes) {
        auto& roots = document.scenes.emplace_back();
        for (const int node : scene.nodes) {
            roots.push_back(link(node));
        }
    }
    for (const auto& texture : model.textures) {
        document.textures.push_back({link(texture.source), link(texture.sampler)});
    }
    for (const auto& sampler : model.samplers) {
        document.samplers.push_back({link(sampler.wrapS), link(sampler.wrapT),
                                     link(sampler.magFilter), link(sampler.minFilter)});
    }
    return document;
}

}  // namespace opaline::formats::gltf
