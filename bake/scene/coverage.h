#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "bake/scene/body_shells.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Whether light passes a material's surfaces straight as through thin glass (Sheet::clear).
inline bool is_clear(const formats::Material& material) {
    return material.sheet && material.sheet->clear > 0;
}

/// Whether a material is opaque and lit and seen on both sides: a sheet that reflects all of its
/// base colour.
inline bool is_wall(const formats::Material& material) {
    return material.sheet && material.sheet->reflect == formats::Rgb{1, 1, 1} &&
           material.sheet->transmit == formats::Rgb{};
}

/// Whether light passes a material's surfaces straight: parts of them are not there
/// (Material::alpha_mode), or are clear.
inline bool has_holes(const formats::Material& material) {
    return (material.alpha_mode != formats::Material::AlphaMode::opaque && !material.medium) ||
           is_clear(material);
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
    float clear = 0, eta = 1.5f;  ///< as Sheet's

    /// Some rays pass by chance.
    bool has_chances() const { return mode == formats::Material::AlphaMode::blend || clear > 0; }
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
    float cosine = 1;  ///< with the triangle's normal, its absolute value
};

/// Whether a ray meets the surface there, and does not pass it as glass. Where a share is, the ray
/// meets it with that probability: a hash of the ray and the triangle decides, so that the answer
/// depends on no order, and the choices of rays, and of layers on one ray, are independent.
bool meets_surface(const Coverage& coverage, const Passage& passage, float u, float v);

/// Bound on the area [m^2] of the holes of a surface: of discs with borders as long as theirs, hole
/// by hole. Open edges that are connected bound one hole. By the isoperimetric inequality pieces of
/// a plane have holes as large as themselves at least, however many they are.
double bound_hole_area(const BodyShells& body);

}  // namespace opaline::bake
