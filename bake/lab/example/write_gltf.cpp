#include "bake/lab/example/write_gltf.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "formats/gltf/gltf_buffer.h"
#include "formats/opal/atomic_file.h"

namespace opaline::bake {
namespace {

using Json = formats::GltfJson;

constexpr const char* kReflectionExtension = "KHR_materials_specular";
constexpr const char* kThinWallExtension = "KHR_materials_diffuse_transmission";
constexpr const char* kEmissionExtension = "KHR_materials_emissive_strength";
constexpr const char* kLightsExtension = "KHR_lights_punctual";

// Millimetres and formulas are in double precision, files in single.
std::vector<formats::Vec3> narrow(const std::vector<glm::dvec3>& vectors) {
    std::vector<formats::Vec3> narrowed;
    narrowed.reserve(vectors.size());
    for (const glm::dvec3& exact : vectors) {
        const glm::vec3 v(exact);
        narrowed.push_back({v.x, v.y, v.z});
    }
    return narrowed;
}

std::size_t add_vectors(formats::GltfBuffer& buffer, const std::vector<glm::dvec3>& vectors) {
    return buffer.add_vectors<formats::Vec3>(narrow(vectors), formats::Bounds::stated);
}

std::size_t add_coordinates(formats::GltfBuffer& buffer,
                            const std::vector<glm::dvec2>& coordinates) {
    std::vector<formats::Float2> narrowed;
    narrowed.reserve(coordinates.size());
    for (const glm::dvec2& exact : coordinates) {
        const glm::vec2 v(exact);
        narrowed.push_back({v.x, v.y});
    }
    return buffer.add_vectors<formats::Float2>(narrowed, formats::Bounds::none);
}

std::size_t add_corners(formats::GltfBuffer& buffer, const TriangleMesh& mesh) {
    std::vector<std::uint32_t> corners;
    corners.reserve(3 * mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles) {
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    return buffer.add_indices(corners);
}

void name_once(Json& extensions, const char* name) {
    if (std::find(extensions.begin(), extensions.end(), name) == extensions.end()) {
        extensions.push_back(name);
    }
}

/// Of an image that several materials may use.
std::size_t index_of_image(const std::string& file, Json& images) {
    const Json image = {{"uri", file}};
    const auto found = std::find(images.begin(), images.end(), image);
    const auto index = static_cast<std::size_t>(found - images.begin());
    if (found == images.end()) {
        images.push_back(image);
    }
    return index;
}

}  // namespace

formats::Result<std::vector<std::filesystem::path>> write_gltf(
    const std::filesystem::path& folder, const std::string& name,
    const std::vector<GltfObject>& objects, const std::string& media,
    const std::vector<GltfPointLight>& lights) {
    formats::GltfBuffer buffer;
    Json nodes = Json::array(), roots = Json::array();
    Json meshes = Json::array(), materials = Json::array(), images = Json::array();
    Json extensions = Json::array({kReflectionExtension});
    for (const GltfObject& object : objects) {
        assert(!object.mesh.position.empty() && !object.mesh.triangles.empty());
        assert(object.mesh.normal.size() == object.mesh.position.size());
        roots.push_back(nodes.size());
        nodes.push_back({{"name", object.name}, {"mesh", meshes.size()}});
        const std::size_t position = add_vectors(buffer, object.mesh.position);
        const std::size_t normal = add_vectors(buffer, object.mesh.normal);
        const std::size_t indices = add_corners(buffer, object.mesh);
        Json attributes = {{"POSITION", position}, {"NORMAL", normal}};
        if (!object.image.empty() || !object.normal_map.empty()) {
            assert(object.texcoord.size() == object.mesh.position.size());
            attributes["TEXCOORD_0"] = add_coordinates(buffer, object.texcoord);
        }
        const Json primitive = {
            {"attributes", attributes}, {"indices", indices}, {"material", materials.size()}};
        meshes.push_back({{"name", object.name}, {"primitives", Json::array({primitive})}});
        const auto& color = object.base_color;
        materials.push_back(
            {{"name", object.material},
             {"pbrMetallicRoughness",
              {{"baseColorFactor", {color[0], color[1], color[2], 1.0}},
               {"metallicFactor", object.reflection.metallic},
               {"roughnessFactor", object.reflection.roughness}}},
             {"extensions",
              {{kReflectionExtension, {{"specularFactor", object.reflection.strength}}}}}});
        if (!object.image.empty()) {
            materials.back()["pbrMetallicRoughness"]["baseColorTexture"] = {
                {"index", index_of_image(object.image, images)}};
        }
        if (!object.normal_map.empty()) {
            materials.back()["normalTexture"] = {
                {"index", index_of_image(object.normal_map, images)}};
        }
        if (const GltfThinWall& thin = object.thin_wall; thin.share > 0) {
            Json& material = materials.back();
            material["doubleSided"] = true;
            material["extensions"][kThinWallExtension] = {
                {"diffuseTransmissionFactor", thin.share},
                {"diffuseTransmissionColorFactor", thin.color}};
            name_once(extensions, kThinWallExtension);
        }
        if (const GltfEmission& emission = object.emission;
            emission.color != std::array<double, 3>{}) {
            Json& material = materials.back();
            material["emissiveFactor"] = emission.color;
            material["extensions"][kEmissionExtension] = {{"emissiveStrength", emission.strength}};
            name_once(extensions, kEmissionExtension);
        }
    }
    Json light_sources = Json::array();
    for (const GltfPointLight& light : lights) {
        roots.push_back(nodes.size());
        nodes.push_back({{"name", light.name},
                         {"translation", light.position},
                         {"extensions", {{kLightsExtension, {{"light", light_sources.size()}}}}}});
        light_sources.push_back({{"type", "point"},
                                 {"name", light.name},
                                 {"color", light.color},
                                 {"intensity", light.intensity}});
        name_once(extensions, kLightsExtension);
    }
    Json document = {
        {"asset", {{"version", "2.0"}, {"generator", "Opaline"}}},
        {"extensionsUsed", extensions},
        {"scene", 0},
        {"scenes", Json::array({{{"name", name}, {"nodes", roots}}})},
        {"nodes", nodes},
        {"meshes", meshes},
        {"materials", materials},
        {"accessors", buffer.accessors()},
        {"bufferViews", buffer.views()},
        {"buffers",
         Json::array({{{"uri", name + ".bin"}, {"byteLength", buffer.bytes().size()}}})}};

    if (!images.empty()) {
        document["images"] = images;
        document["textures"] = Json::array();
        for (std::size_t i = 0; i < images.size(); ++i) {
            document["textures"].push_back({{"source", i}});
        }
    }
    if (!lights.empty()) {
        document["extensions"][kLightsExtension] = {{"lights", light_sources}};
    }
    if (!media.empty()) {
        document["extensionsUsed"].push_back("OPALINE_media");
        document["extensions"]["OPALINE_media"] = Json::parse(media);
    }
    const std::vector<std::filesystem::path> files = {folder / (name + ".bin"),
                                                      folder / (name + ".gltf")};
    const std::string contents[] = {buffer.bytes(), document.dump(2) + "\n"};
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (formats::Status written = formats::write_file_atomically(files[i], contents[i]);
            !written) {
            return std::move(written).error();
        }
    }
    return std::vector<std::filesystem::path>{files[1], files[0]};
}

}  // namespace opaline::bake
