#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "formats/gltf/gltf_buffer.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// The part of light that a surface with this record sends out itself, where it is there: below 1
/// for thin glass, whose rest passes, as seen along the normal. A renderer that blends by it needs
/// colours divided by it.
float unlit_cover(const HoleRecord& hole);

/// Materials of KHR_materials_unlit while they are collected, equal ones once, with their images,
/// which go into the buffer as PNG.
class UnlitMaterials {
  public:
    explicit UnlitMaterials(const AssetView& asset) : asset_(&asset) {}

    /// Of a primitive; returns the material's index. Errors: those of encode_png.
    Result<std::size_t> add(std::uint32_t primitive, const std::string& name, GltfBuffer& buffer);

    /// Whether a material needs texture coordinates.
    bool has_image(std::size_t material) const;

    /// Adds the arrays `materials`, and `textures`, `samplers` and `images` where there are any.
    void put_into(GltfJson& document) const;

  private:
    Result<std::size_t> add_image(std::uint32_t color, std::uint32_t alpha, GltfBuffer& buffer);

    // An array of entries, equal ones once.
    struct Distinct {
        GltfJson array = GltfJson::array();
        std::map<std::string, std::size_t> index_of;  ///< by the entry's text

        std::size_t add(const GltfJson& entry);
    };

    const AssetView* asset_;
    Distinct materials_, textures_, samplers_;
    GltfJson images_ = GltfJson::array();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> image_of_;  // colour, alpha
};

}  // namespace opaline::formats
