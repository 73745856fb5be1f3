#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/scene/sample_image.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Change of a triangle's texture coordinates over its plane [1/m], d(uv)/dP, beyond its edges too.
/// 0 without coordinates or area. `first_index`: of its first corner in Primitive::index.
glm::dmat3x2 uv_gradient(const formats::Primitive& primitive, std::uint32_t first_index);

/// Of a square of that area [m^2] in the plane, turned in any way: a cell of which no more is
/// known.
UvMoments moments_of_area(const glm::dmat3x2& duv_dP, double area);

/// Of a parallelogram with these edges [m].
UvMoments moments_of_edges(const glm::dmat3x2& duv_dP, const glm::dvec3& a, const glm::dvec3& b);

/// Of the part of a surface that is seen in a small cone around a ray of `distance` [m] that meets
/// it: a square of `solid_angle` [sr] thrown onto the plane. `direction`, `normal`: unit.
UvMoments moments_of_cone(const glm::dmat3x2& duv_dP, const glm::dvec3& direction,
                          const glm::dvec3& normal, double distance, double solid_angle);

/// Of a triangle with these texture coordinates.
UvMoments moments_of_triangle(const std::array<glm::dvec2, 3>& uv);

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
