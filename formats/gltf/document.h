#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "formats/scene.h"

namespace opaline::formats::gltf {

/// The parts of a glTF file that Opaline uses, as plain values. Names and meanings are the
/// specification's; indices are kNone where absent.

enum class ComponentType : std::uint32_t {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
};

struct BufferView {
    std::uint32_t buffer = kNone;
    std::uint64_t offset = 0, length = 0;
    std::uint64_t stride = 0;  ///< 0: elements follow each other without gaps
};

struct Sparse {
    std::uint64_t count = 0;
    std::uint32_t index_view = kNone, value_view = kNone;
    std::uint64_t index_offset = 0, value_offset = 0;
    ComponentType index_type = ComponentType::uint16;
};

struct Accessor {
    std::uint32_t view = kNone;  ///< kNone: all zero before the sparse values
    std::uint64_t offset = 0, count = 0;
    ComponentType type = ComponentType::float32;
    std::uint32_t components = 1;  ///< 1 to 4; 4, 9, 16 for matrices
    bool is_matrix = false;
    bool normalized = false;
    std::optional<Sparse> sparse;
};

enum class Mode : std::uint32_t {
    points,
    lines,
    line_loop,
    line_strip,
    triangles,
    triangle_strip,
    triangle_fan
};

using Attributes = std::map<std::string, std::uint32_t>;  ///< semantic -> accessor

struct MeshPrimitive {
    Attributes attributes;
    std::vector<Attributes> targets;  ///< morph targets: what each adds to the attributes
    std::uint32_t indices = kNone, material = kNone;
    Mode mode = Mode::triangles;
};

struct Mesh {
    std::string name;
    std::vector<MeshPrimitive> primitives;
    std::vector<double> weights;  ///< of morph targets at rest, where a node states none
};

struct Skin {
    std::vector<std::uint32_t> joints;            ///< nodes; not empty
    std::uint32_t inverse_bind_matrices = kNone;  ///< accessor; none: identities
};

struct Node {
    std::string name;
    std::uint32_t mesh = kNone, light = kNone, skin = kNone;
    std::vector<std::uint32_t> children;
    glm::dmat4 local{1.0};        ///< to the parent's frame
    std::vector<double> weights;  ///< of the mesh's morph targets at rest; empty: the mesh's
    Attributes instances;         ///< EXT_mesh_gpu_instancing; empty: the mesh is placed once
    bool has_camera = false;
    std::vector<std::string> extensions;
};

struct TextureUse {
    std::uint32_t texture = kNone, texcoord = 0;
    glm::mat3 transform{1.0f};  ///< KHR_texture_transform
};

/// What says how a material's surface reflects and what is inside, with the defaults of the
/// specifications.
struct TranslucencySource {
    bool has_volume = false, has_transmission = false, has_diffuse_transmission = false;
    bool has_specular = false, has_ior = false;
    bool has_scatter = false;         ///< KHR_materials_scatter
    bool has_volume_scatter = false;  ///< its predecessor, KHR_materials_volume_scatter
    double transmission = 0.0, diffuse_transmission = 0.0;
    glm::dvec3 diffuse_transmission_color{1.0};
    double thickness = 0.0;                                                 ///< 0: thin-walled
    double attenuation_distance = std::numeric_limits<double>::infinity();  ///< file units
    glm::dvec3 attenuation_color{1.0};
    double ior = 1.5;  ///< 0: of infinite Fresnel reflectance
    double specular = 1.0;
    glm::dvec3 specular_color{1.0};
    std::optional<double> scatter_strength;  ///< default 0
    glm::dvec3 multiscatter_color{1.0};      ///< of whichever scatter extension there is
    double anisotropy = 0.0;
    double metallic = 1.0, roughness = 1.0;
    bool states_reflection = false;  ///< metallicFactor, roughnessFactor or their texture
    bool is_diffuse = false;         ///< unlit
    TextureUse scatter_strength_texture, multiscatter_color_texture;
    std::vector<std::string> textures;  ///< names of the members above that a texture modulates and
                                        ///< nothing reads
};

/// What a surface sends out by itself.
struct EmissionSource {
    glm::dvec3 factor{0.0};
    double strength = 1.0;  ///< KHR_materials_emissive_strength
    TextureUse texture;
};

/// KHR_lights_punctual, with its defaults.
struct LightSource {
    std::string name;
    Light::Type type = Light::Type::point;
    glm::dvec3 color{1.0};
    double intensity = 1.0;       ///< [cd] or [lx]
    std::optional<double> range;  ///< file units
    double inner_cone = 0.0, outer_cone = std::numbers::pi / 4;
};

/// KHR_materials_pbrSpecularGlossiness, with its defaults.
struct SpecularGlossiness {
    glm::dvec4 diffuse{1.0};
    glm::dvec3 specular{1.0};
    double glossiness = 1.0;
    TextureUse diffuse_texture;
    TextureUse specular_glossiness_texture;  ///< specular as sRGB codes; alpha: glossiness
};

struct MaterialSource {
    std::string name;
    glm::dvec4 base_color{1.0};
    TextureUse base_color_texture, metallic_roughness_texture, normal_texture;
    double normal_scale = 1.0;  ///< of normal_texture
    EmissionSource emission;
    bool double_sided = false, has_occlusion_map = false;
    std::string alpha_mode;
    double alpha_cutoff = 0.5;
    std::vector<std::string> extensions;
    TranslucencySource translucency;
    std::optional<SpecularGlossiness> specular_glossiness;
};

struct Texture {
    std::uint32_t image = kNone, sampler = kNone;
};

struct Sampler {
    std::uint32_t wrap_s = 10497, wrap_t = 10497;
    std::uint32_t mag_filter = kNone, min_filter = kNone;
};

struct ImageSource {
    std::string name, uri;
    std::uint32_t view = kNone;  ///< used where `uri` is empty
};

struct Document {
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Skin> skins;
    std::vector<std::vector<std::uint32_t>> scenes;  ///< nodes that each lists
    std::uint32_t default_scene = kNone;
    std::vector<MaterialSource> materials;
    std::vector<LightSource> lights;
    std::vector<Texture> textures;
    std::vector<Sampler> samplers;
    std::vector<ImageSource> images;
    bool has_animations = false;
};

/// Bytes of one component; 0 for a type that glTF does not have.
constexpr std::uint32_t component_bytes(ComponentType type) {
    switch (type) {
        case ComponentType::int8:
        case ComponentType::uint8:
            return 1;
        case ComponentType::int16:
        case ComponentType::uint16:
            return 2;
        case ComponentType::uint32:
        case ComponentType::float32:
            return 4;
    }
    return 0;
}

}  // namespace opaline::formats::gltf
