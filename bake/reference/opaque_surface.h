#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "bake/reference/hit_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What a point of an opaque surface reflects with: factors and textures looked up.
struct OpaqueSurface {
    glm::vec3 base_color{1};
    float metallic = 0, roughness = 1;
    glm::vec3 f0{0};                    ///< of its dielectric part: reflectance at normal incidence
    float f90 = 0;                      ///< and at grazing; 0: none
    glm::vec3 reflect{1}, transmit{0};  ///< shares of diffuse light that stay on this side, and not

    bool is_diffuse() const { return metallic == 0 && f90 == 0; }
};

/// `view`: as base_color_at's.
OpaqueSurface opaque_surface_at(const formats::Scene& scene, const SurfaceHit& hit,
                                const TextureView* view = nullptr);
OpaqueSurface opaque_surface_at_vertex(const formats::Scene& scene, std::uint32_t primitive,
                                       std::uint32_t vertex);

}  // namespace opaline::bake
