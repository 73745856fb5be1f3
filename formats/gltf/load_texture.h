#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// A texture whose image is in Scene::images; `image` is kNone where it cannot be read.
struct LoadedTexture {
    std::uint32_t image = kNone;
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
};

/// Linear values of sRGB codes.
std::array<double, 256> decoded_codes();
/// The linear mean of an image's colours, and of its alpha.
glm::dvec4 mean_texel(const Image8& image);

/// Decodes the images of textures, each once. Errors go to `report`. All that it is given must
/// outlive it, and the links between them must be valid (validate_document).
class TextureLoader {
  public:
    TextureLoader(const Document& document, Resources& resources, Scene& scene, Report& report)
        : document_(document), resources_(resources), scene_(scene), report_(report) {}

    /// `where` names the material, for messages.
    LoadedTexture load(std::uint32_t texture, const std::string& where);
    /// The same with the image in Scene::inner_images.
    LoadedTexture load_inner(std::uint32_t texture, const std::string& where);
    /// How a texture is looked up, without its image.
    LoadedTexture sampler_of(std::uint32_t texture);
    /// Decodes the image without adding it to the scene. Nothing if it cannot be read.
    std::optional<Image8> decode(std::uint32_t texture, const std::string& where);

  private:
    using Known = std::map<std::uint32_t, std::uint32_t>;  // glTF image -> index into images
    std::optional<Image8> decode_image(std::uint32_t index);
    LoadedTexture load_into(std::vector<Image8>& images, Known& known, std::uint32_t texture,
                            const std::string& where);

    const Document& document_;
    Resources& resources_;
    Scene& scene_;
    Report& report_;
    Known known_, known_inner_;  ///< of Scene::images and Scene::inner_images
};

}  // namespace opaline::formats::gltf
