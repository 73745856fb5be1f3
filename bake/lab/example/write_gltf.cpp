#include "bake/lab/example/write_gltf.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "formats/opal/atomic_file.h"

namespace opaline::bake {
namespace {

// Keys in the order of writing: the file reads like the specification's examples.
using Json = nlohmann::ordered_json;

// Values fixed by the glTF 2.0 specification.
constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr const char* kReflectionExtension = "KHR_materials_specular";
constexpr const char* kThinWallExtension = "KHR_materials_diffuse_transmission";
constexpr const char* kEmissionExtension = "KHR_materials_emissive_strength";
constexpr const char* kLightsExtension = "KHR_lights_punctual";

void append(std::string& bytes, std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) {
        bytes.push_back(static_cast<char>(word >> shift & 0xffu));
    }
}

/// Both files while they grow. Every element is a 4-byte word, so all views stay aligned.
struct Draft {
    Json views = Json::array(), accessors = Json::array();
    std::string bytes;
};

/// Adds a view of `count` elements from `offset` to the end of the bytes, and the accessor of all
/// of it; returns the accessor's index.
std::size_t add_accessor(Draft& draft, std::size_t offset, int target, int component,
                         const char* type, std::size_t count) {
    draft.views.push_back({{"buffer", 0},
                           {"byteOffset", offset},
                           {"byteLength", draft.bytes.size() - offset},
                           {"target", target}});
    draft.accessors.push_back({{"bufferView", draft.views.size() - 1},
                               {"componentType", component},
                               {"count", count},
                               {"type", type}});
    return draft.accessors.size() - 1;
}

/// Adds vectors as floats, with the smallest and largest of each coordinate as they were rounded.
std::size_t add_vectors(Draft& draft, const std::vector<glm::dvec3>& vectors) {
    const std::size_t offset = draft.bytes.size();
    glm::vec3 low(vectors.front()), high(low);
    for (const glm::dvec3& exact : vectors) {
        const glm::vec3 vector(exact);
        low = glm::min(low, vector);
        high = glm::max(high, vector);
        for (int axis = 0; axis < 3; ++axis) {
            append(draft.bytes, std::bit_cast<std::uint32_t>(vector[axis]));
        }
    }
    const std::size_t index =
        add_accessor(draft, offset, kArrayBuffer, kFloat, "VEC3", vectors.size());
    draft.accessors[index]["min"] = {low.x, low.y, low.z};
    draft.accessors[index]["max"] = {high.x, high.y, high.z};
    return index;
}

std::size_t add_texture_coordinates(Draft& draft, const std::vector<glm::dvec2>& coordinates) {
    const std::size_t offset = draft.bytes.size();
    for (const glm::dvec2& exact : coordinates) {
        append(draft.bytes, std::bit_cast<std::uint32_t>(static_cast<float>(exact.x)));
        append(draft.bytes, std::bit_cast<std::uint32_t>(static_cast<float>(exact.y)));
    }
    return add_accessor(draft, offset, kArrayBuffer, kFloat, "VEC2", coordinates.size());
}

std::size_t add_indices(Draft& draft, const TriangleMesh& mesh) {
    const std::size_t offset = draft.bytes.size();
    std::uint32_t low = mesh.triangles.front()[0], high = low;
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t v : triangle) {
            append(draft.bytes, v);
            low = std::min(low, v);
            high = std::max(high, v);
        }
    }
    const std::size_t index = add_accessor(draft, offset, kElementArrayBuffer, kUnsignedInt,
                                           "SCALAR", 3 * mesh.triangles.size());
    draft.accessors[index]["min"] = {low};
    draft.accessors[index]["max"] = {high};
    return index;
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
    Draft draft;
    Json nodes = Json::array(), roots = Json::array();
    Json meshes = Json::array(), materials = Json::array(), images = Json::array();
    Json extensions = Json::array({kReflectionExtension});
    for (const GltfObject& object : objects) {
        assert(!object.mesh.position.empty() && !object.mesh.triangles.empty());
        assert(object.mesh.normal.size() == object.mesh.position.size());
        roots.push_back(nodes.size());
        nodes.push_back({{"name", object.name}, {"mesh", meshes.size()}});
        const std::size_t position = add_vectors(draft, object.mesh.position);
        const std::size_t normal = add_vectors(draft, object.mesh.normal);
        const std::size_t indices = add_indices(draft, object.mesh);
        Json attributes = {{"POSITION", position}, {"NORMAL", normal}};
        if (!object.image.empty() || !object.normal_map.empty()) {
            assert(object.texcoord.size() == object.mesh.position.size());
            attributes["TEXCOORD_0"] = add_texture_coordinates(draft, object.texcoord);
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
        {"accessors", draft.accessors},
        {"bufferViews", draft.views},
        {"buffers", Json::array({{{"uri", name + ".bin"}, {"byteLength", draft.bytes.size()}}})}};

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
    const std::string contents[] = {std::move(draft.bytes), document.dump(2) + "\n"};
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (formats::Status written = formats::write_file_atomically(files[i], contents[i]);
            !written) {
            return std::move(written).error();
        }
    }
    return std::vector<std::filesystem::path>{files[1], files[0]};
}

}  // namespace opaline::bake
