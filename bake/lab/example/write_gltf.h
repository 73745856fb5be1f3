#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bake/lab/example/triangle_mesh.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// glTF's metallic-roughness model. The default is a surface that reflects diffusely alone, which
/// the file says outright: glTF's own default is a rough metal.
struct GltfReflection {
    double metallic = 0, roughness = 1;
    double strength = 0;  ///< specularFactor of KHR_materials_specular
};

/// Thin-walled: KHR_materials_diffuse_transmission. The default is opaque.
struct GltfThinWall {
    double share = 0;                      ///< diffuseTransmissionFactor, in [0, 1]
    std::array<double, 3> color{1, 1, 1};  ///< linear Rec. 709, each in [0, 1]
};

/// Light that a surface sends out: emissiveFactor and KHR_materials_emissive_strength.
struct GltfEmission {
    std::array<double, 3> color{0, 0, 0};  ///< each in [0, 1]; all 0: none
    double strength = 1;                   ///< [nit]
};

/// A point light of KHR_lights_punctual in a node of its own.
struct GltfPointLight {
    std::string name;
    std::array<double, 3> color{1, 1, 1};
    double intensity = 1;  ///< [cd]
    std::array<double, 3> position{0, 0, 0};
};

/// A mesh in a node of its own. Names are free; several objects may not share a material name.
struct GltfObject {
    std::string name;                           ///< of node and mesh
    std::string material;                       ///< media files match it by this name
    std::array<double, 3> base_color{1, 1, 1};  ///< linear Rec. 709, each in [0, 1]
    TriangleMesh mesh;                          ///< positions in metres, one unit normal each
    GltfReflection reflection = {};
    GltfThinWall thin_wall = {};
    GltfEmission emission = {};
    std::vector<glm::dvec2> texcoord = {};  ///< one a vertex where there is an image
    std::string image = {};  ///< file of the base colour's image, beside the .gltf; empty: none
    std::string normal_map = {};  ///< of its normal map, likewise
};

/// Writes FOLDER/NAME.gltf and its buffer FOLDER/NAME.bin as glTF 2.0 and returns both paths; the
/// buffer appears first, so that the .gltf never refers to a missing file. The bytes depend on the
/// arguments only. `media`: a media file (formats/media/README.md) for the extension OPALINE_media,
/// or nothing. Errors: resource, if either file cannot be written. Precondition: every object has a
/// vertex, a triangle, and as many normals as positions, and texture coordinates where it has an
/// image.
formats::Result<std::vector<std::filesystem::path>> write_gltf(
    const std::filesystem::path& folder, const std::string& name,
    const std::vector<GltfObject>& objects, const std::string& media = {},
    const std::vector<GltfPointLight>& lights = {});

}  // namespace opaline::bake
