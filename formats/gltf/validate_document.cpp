#include "formats/gltf/validate_document.h"

#include <algorithm>
#include <string>

namespace opaline::formats::gltf {

namespace {

std::string number(std::uint64_t value) {
    return std::to_string(value);
}

/// Does [offset, offset + length) fit in `size`? No sum that could wrap.
bool fits(std::uint64_t offset, std::uint64_t length, std::uint64_t size) {
    return offset <= size && length <= size - offset;
}

/// Bytes from the first to past the last element. Counts and strides below 2^40 and 2^8: no wrap.
std::uint64_t span_bytes(std::uint64_t count, std::uint64_t stride, std::uint64_t element) {
    return count == 0 ? 0 : (count - 1) * stride + element;
}

void check_link(std::uint32_t index, std::size_t size, const std::string& where, const char* what,
                Report& report) {
    if (index != kNone && index >= size) {
        report.error(where, std::string(what) + " " + number(index) +
                                " does not exist: there are " + number(size));
    }
}

void validate_views(const Document& document, const std::vector<Bytes>& buffers, Report& report) {
    for (std::size_t i = 0; i < document.views.size(); ++i) {
        const BufferView& view = document.views[i];
        const std::string where = "bufferView " + number(i);
        if (view.buffer >= buffers.size()) {
            report.error(where, "buffer " + number(view.buffer) + " does not exist: there are " +
                                    number(buffers.size()));
        } else if (!fits(view.offset, view.length, buffers[view.buffer].size())) {
            report.error(where, "its bytes " + number(view.offset) + " to " +
                                    number(view.offset + view.length) + " pass the end of buffer " +
                                    number(view.buffer) + " (" +
                                    number(buffers[view.buffer].size()) + " bytes)");
        }
    }
}

/// One run of elements inside a view: an accessor's own, or one half of a sparse block.
void check_run(const Document& document, std::uint32_t view_index, std::uint64_t offset,
               std::uint64_t count, std::uint64_t element, std::uint64_t component,
               const std::string& where, Report& report) {
    if (view_index >= document.views.size()) {
        report.error(where, "bufferView " + number(view_index) + " does not exist: there are " +
                                number(document.views.size()));
        return;
    }
    const BufferView& view = document.views[view_index];
    const std::uint64_t stride = view.stride == 0 ? element : view.stride;
    if (stride < element) {
        report.error(where, "byteStride " + number(stride) + " is smaller than its elements of " +
                                number(element) + " bytes");
    } else if (count > kMaxFileBytes ||
               !fits(offset, span_bytes(count, stride, element), view.length)) {
        report.error(where, number(count) + " elements from byte " + number(offset) +
                                " pass the end of bufferView " + number(view_index) + " (" +
                                number(view.length) + " bytes)");
    } else if ((offset % component) != 0 || (stride % component) != 0) {
        report.error(where, "byteOffset " + number(offset) + " or byteStride " + number(stride) +
                                " is not a multiple of the component size " + number(component));
    }
}

void validate_accessor(const Document& document, std::size_t index, Report& report) {
    const Accessor& accessor = document.accessors[index];
    const std::string where = "accessor " + number(index);
    const std::uint64_t component = component_bytes(accessor.type);
    if (component == 0) {
        report.error(where, "componentType " + number(static_cast<std::uint32_t>(accessor.type)) +
                                " is not one of glTF");
        return;
    }
    if (accessor.count == 0) {
        report.error(where, "count is 0, expected at least 1");
        return;
    }
    if (accessor.is_matrix && accessor.components != 16) {
        return;  // nothing reads them, and their columns have gaps
    }
    const std::uint64_t element = component * accessor.components;
    if (accessor.view != kNone) {
        check_run(document, accessor.view, accessor.offset, accessor.count, element, component,
                  where, report);
    } else if (accessor.count > kMaxImplicitElements) {
        report.over_limit(where,
                          number(accessor.count) + " elements without a bufferView, the limit is " +
                              number(kMaxImplicitElements),
                          "store the elements in a buffer");
    }
    if (!accessor.sparse) return;
    const Sparse& sparse = *accessor.sparse;
    const bool whole = sparse.index_type == ComponentType::uint8 ||
                       sparse.index_type == ComponentType::uint16 ||
                       sparse.index_type == ComponentType::uint32;
    if (!whole) {
        report.error(where, "its sparse indices have componentType " +
                                number(static_cast<std::uint32_t>(sparse.index_type)));
        return;
    }
    if (sparse.count == 0 || sparse.count > accessor.count) {
        report.error(where, "its sparse count is " + number(sparse.count) + ", expected 1 to " +
                                number(accessor.count));
        return;
    }
    const std::uint64_t index_bytes = component_bytes(sparse.index_type);
    check_run(document, sparse.index_view, sparse.index_offset, sparse.count, index_bytes,
              index_bytes, where + " > sparse indices", report);
    check_run(document, sparse.value_view, sparse.value_offset, sparse.count, element, component,
              where + " > sparse values", report);
}

void validate_links(const Document& document, Report& report) {
    for (std::size_t m = 0; m < document.meshes.size(); ++m) {
        const Mesh& mesh = document.meshes[m];
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            const MeshPrimitive& primitive = mesh.primitives[p];
            const std::string where = label("mesh", m, mesh.name) + " > primitive " + number(p);
            check_link(primitive.indices, document.accessors.size(), where, "accessor", report);
            check_link(primitive.material, document.materials.size(), where, "material", report);
            for (const auto& [semantic, accessor] : primitive.attributes) {
                check_link(accessor, document.accessors.size(), where, "accessor", report);
            }
            for (const Attributes& target : primitive.targets) {
                for (const auto& [semantic, accessor] : target) {
                    check_link(accessor, document.accessors.size(), where, "accessor", report);
                }
            }
            if (static_cast<std::uint32_t>(primitive.mode) > 6) {
                report.error(where, "mode is " +
                                        number(static_cast<std::uint32_t>(primitive.mode)) +
                                        ", expected 0 to 6");
            }
        }
    }
    for (std::size_t i = 0; i < document.materials.size(); ++i) {
        const MaterialSource& material = document.materials[i];
        for (const TextureUse& use :
             {material.base_color_texture, material.metallic_roughness_texture,
              material.normal_texture, material.translucency.scatter_strength_texture,
              material.translucency.multiscatter_color_texture, material.emission.texture}) {
            check_link(use.texture, document.textures.size(), label("material", i, material.name),
                       "texture", report);
        }
        if (material.specular_glossiness) {
            for (const TextureUse& use :
                 {material.specular_glossiness->diffuse_texture,
                  material.specular_glossiness->specular_glossiness_texture}) {
                check_link(use.texture, document.textures.size(),
                           label("material", i, material.name), "texture", report);
            }
        }
    }
    for (std::size_t i = 0; i < document.textures.size(); ++i) {
        const std::string where = "texture " + number(i);
        check_link(document.textures[i].image, document.images.size(), where, "image", report);
        check_link(document.textures[i].sampler, document.samplers.size(), where, "sampler",
                   report);
    }
    for (std::size_t i = 0; i < document.images.size(); ++i) {
        check_link(document.images[i].view, document.views.size(),
                   label("image", i, document.images[i].name), "bufferView", report);
    }
}

void validate_skins(const Document& document, Report& report) {
    for (std::size_t i = 0; i < document.skins.size(); ++i) {
        const Skin& skin = document.skins[i];
        const std::string where = "skin " + number(i);
        for (const std::uint32_t joint : skin.joints) {
            check_link(joint, document.nodes.size(), where, "joint node", report);
        }
        const std::uint32_t bind = skin.inverse_bind_matrices;
        check_link(bind, document.accessors.size(), where, "accessor", report);
        if (bind >= document.accessors.size()) continue;
        const Accessor& accessor = document.accessors[bind];
        if (!accessor.is_matrix || accessor.components != 16 ||
            accessor.type != ComponentType::float32) {
            report.error(where, "its inverseBindMatrices are not MAT4 of FLOAT");
        } else if (accessor.count < skin.joints.size()) {
            report.error(where, "it has " + number(skin.joints.size()) + " joints, but " +
                                    number(accessor.count) + " inverse bind matrices");
        }
    }
}

/// Each node at most one parent; then walking down from the parentless nodes reaches every node
/// exactly when there is no cycle.
void validate_nodes(const Document& document, Report& report) {
    const std::size_t count = document.nodes.size();
    std::vector<std::uint32_t> parent(count, kNone);
    bool sound = true;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Node& node = document.nodes[i];
        const std::string where = label("node", i, node.name);
        check_link(node.mesh, document.meshes.size(), where, "mesh", report);
        check_link(node.light, document.lights.size(), where, "light", report);
        check_link(node.skin, document.skins.size(), where, "skin", report);
        for (const auto& [semantic, accessor] : node.instances) {
            check_link(accessor, document.accessors.size(), where, "accessor", report);
        }
        for (const std::uint32_t child : node.children) {
            if (child >= count) {
                check_link(child, count, where, "child node", report);
                sound = false;
            } else if (parent[child] != kNone) {
                report.error(where,
                             "its child " + number(child) + " is also a child of node " +
                                 number(parent[child]),
                             "give every node one parent: duplicate the shared node");
                sound = false;
            } else {
                parent[child] = i;
            }
        }
    }
    for (std::size_t s = 0; s < document.scenes.size(); ++s) {
        for (const std::uint32_t node : document.scenes[s]) {
            check_link(node, count, "scene " + number(s), "node", report);
        }
    }
    if (document.default_scene != kNone) {
        check_link(document.default_scene, document.scenes.size(), "scene", "scene", report);
    }
    if (!sound) return;
    std::vector<bool> reached(count, false);
    std::vector<std::uint32_t> pending;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (parent[i] == kNone) {
            pending.push_back(i);
        }
    }
    while (!pending.empty()) {
        const std::uint32_t node = pending.back();
        pending.pop_back();
        reached[node] = true;
        const auto& children = document.nodes[node].children;
        pending.insert(pending.end(), children.begin(), children.end());
    }
    const auto lost = std::find(reached.begin(), reached.end(), false);
    if (lost != reached.end()) {
        const auto index = static_cast<std::size_t>(lost - reached.begin());
        report.error(label("node", index, document.nodes[index].name),
                     "it is its own ancestor: the node hierarchy has a cycle",
                     "remove the link back to the ancestor");
    }
}

}  // namespace

void validate_document(const Document& document, const std::vector<Bytes>& buffers,
                       Report& report) {
    validate_views(document, buffers, report);
    for (std::size_t i = 0; i < document.accessors.size(); ++i) {
        validate_accessor(document, i, report);
    }
    validate_links(document, report);
    validate_skins(document, report);
    validate_nodes(document, report);
}

}  // namespace opaline::formats::gltf
