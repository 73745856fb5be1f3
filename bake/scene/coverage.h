#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Whether parts of a material's surfaces are not there (Material::alpha_mode).
inline bool has_holes(const formats::Material& material) {
    return material.alpha_mode != formats::Material::AlphaMode::opaque && !material.medium;
}

/// What says where a primitive's surface is: a copy of its own, which outlives the scene.
struct Coverage {
    formats::Material::AlphaMode mode = formats::Material::AlphaMode::mask;
    float alpha = 1, cutoff = 0.5f;
    std::vector<std::uint32_t> index;  ///< as Primitive::index
    std::vector<float> vertex_alpha;   ///< empty: 1
    std::vector<glm::vec2> texcoord;
    std::shared_ptr<const formats::Image8> image;  ///< null: 1; its alpha counts
    formats::TextureWrap wrap_u{}, wrap_v{};
};

/// Images that coverages share, by index into Scene::images.
using CoverageImages = std::map<std::uint32_t, std::shared_ptr<const formats::Image8>>;

/// Of one primitive; nothing where its material has no holes. `images` gains what it needs.
std::optional<Coverage> make_coverage(const formats::Scene& scene, std::uint32_t primitive,
                                      CoverageImages& images);

/// Share of the surface that is there, in [0, 1], at weights u, v of a triangle's second and third
/// corner: 0 or 1 of a mask.
float coverage_at(const Coverage& coverage, std::uint32_t triangle, float u, float v);

/// A ray, as far as its bits go, and the triangle that it may pass.
struct Passage {
    glm::vec3 origin{0}, direction{0};
    std::uint32_t key = 0;  ///< another one makes other choices
    std::uint32_t primitive = 0, triangle = 0;
};

/// Whether a ray meets the surface there. Where a share is, the ray meets it with that probability:
/// a hash of the ray and the triangle decides, so that the answer depends on no order, and the
/// choices of rays, and of layers on one ray, are independent.
bool meets_surface(const Coverage& coverage, const Passage& passage, float u, float v);

}  // namespace opaline::bake
