#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "bake/scene/texture_pyramid.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A point of a primitive: weights over three of its vertices.
struct SurfacePlace {
    std::uint32_t primitive = 0;
    std::array<std::uint32_t, 3> corner{};
    std::array<float, 3> weight{};
};
/// `first_index`: of the triangle's first corner in Primitive::index.
SurfacePlace surface_place(const formats::Scene& scene, std::uint32_t primitive,
                           std::uint32_t first_index, const glm::vec3& weight);

// `view`: what textures are looked up over; null: at the point, bilinear. Vertex colours and veins
// are those of the point.

/// Base colour: factor, vertex colours, veins and texture (in linear light).
glm::vec3 base_color(const formats::Scene& scene, const SurfacePlace& place,
                     const TextureView* view = nullptr);

/// Its texture alone; 1 without one.
glm::vec3 base_color_texture(const formats::Scene& scene, const SurfacePlace& place,
                             const TextureView* view = nullptr);

/// What the texture of gloss multiplies roughness (g) and metallic (b) by; 1 without one.
glm::vec3 roughness_texture(const formats::Scene& scene, const SurfacePlace& place,
                            const TextureView* view = nullptr);

/// The codes of its normal map over 255, at the point. Precondition: it has one and coordinates.
glm::vec3 normal_texture(const formats::Scene& scene, const SurfacePlace& place);

/// Of emission; 1 without one.
glm::vec3 emission_texture(const formats::Scene& scene, const SurfacePlace& place,
                           const TextureView* view = nullptr);

/// Whether some light comes from surfaces of the material, as far as its factor tells.
inline bool is_emissive(const formats::Material& material) {
    return material.emission.r > 0 || material.emission.g > 0 || material.emission.b > 0;
}

/// Radiance [nit] that a surface sends out by itself, the same in all directions, at a point of a
/// primitive: weights over three of its vertices. It leaves the front, and of a double-sided
/// material the back too. `view`: what its texture is looked up over; null: at the point.
formats::Rgb emission_at(const formats::Scene& scene, std::uint32_t primitive,
                         const std::array<std::uint32_t, 3>& corner,
                         const std::array<float, 3>& weight, const TextureView* view = nullptr);

}  // namespace opaline::bake
