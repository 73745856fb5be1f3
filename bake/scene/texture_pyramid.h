#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/scene/sample_image.h"
#include "bake/scene/texture_taps.h"
#include "formats/scene.h"

namespace opaline::bake {

/// An image and its coarser versions, each half as large as the one before and the mean over area
/// of it, down to one texel. Level 0 is the image itself. Values are linear.
struct TexturePyramid {
    struct Level {
        std::uint32_t width = 0, height = 0;
        std::vector<glm::vec4> texel;  ///< row-major
    };
    std::vector<Level> coarser;  ///< levels 1, 2, ...
};

/// All texels are the same, or there is none.
bool is_even(const formats::Image8& image);

/// `is_linear`: as ImageLookup's. Precondition: the image is not empty.
TexturePyramid make_pyramid(const formats::Image8& image, bool is_linear);

/// Mean of a texture over a footprint: look-ups in two levels along its longer axis, at most
/// kMostTaps. One below a texel gives `sample_image`. `pyramid` is that of the lookup's image.
inline constexpr int kMostTaps = 8;
glm::vec4 sample_footprint(const ImageLookup& lookup, const TexturePyramid& pyramid, glm::vec2 uv,
                           const UvMoments& footprint);

/// Of the images that materials of a scene use, by index into Scene::images. Empty where no
/// material uses one that way, or where all of its texels are the same. Without any: textures are
/// looked up at points.
struct ScenePyramids {
    std::vector<TexturePyramid> color;  ///< from sRGB codes
    std::vector<TexturePyramid> data;   ///< from linear codes: gloss

    /// False: nothing is there to filter.
    bool any() const;
};

/// What textures are looked up over.
struct TextureView {
    const ScenePyramids& pyramids;
    UvMoments moments;
};

/// sample_footprint of image `number` of the scene, or sample_image where `view` is null.
glm::vec4 sample_over(const ImageLookup& lookup, std::uint32_t number, glm::vec2 uv,
                      const TextureView* view);

/// Of all materials; with `of_material` of those that it names (by index, not 0) alone.
ScenePyramids make_scene_pyramids(const formats::Scene& scene,
                                  std::span<const std::uint8_t> of_material = {});

/// Whether a material has an image with a pyramid.
bool has_pyramid(const ScenePyramids& pyramids, const formats::Material& material);

}  // namespace opaline::bake
