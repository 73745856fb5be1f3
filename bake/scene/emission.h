#pragma once

#include <array>
#include <cstdint>

#include "bake/scene/texture_pyramid.h"
#include "formats/scene.h"

namespace opaline::bake {

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
