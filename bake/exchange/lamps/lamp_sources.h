#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/exchange/lamps/lamps.h"
#include "bake/scene/texture_pyramid.h"

namespace opaline::bake {

/// A glowing triangle; or a part of one over which its texture counts as constant.
struct GlowingTriangle {
    std::array<glm::dvec3, 3> corner{};
    glm::dvec3 normal{0};    ///< unit, of the front
    double area = 0;         ///< [m^2], > 0
    glm::dvec3 radiance{0};  ///< [nit], mean
    bool is_two_sided = false;

    /// Power [lm] of both sides that glow.
    glm::dvec3 power() const;
};

/// Of radiance 0. Where its area is 0, so is its normal.
GlowingTriangle make_glowing_triangle(const std::array<glm::dvec3, 3>& corner, bool is_two_sided);

/// A textured triangle or a part of it, that stands for its own parts where it is far away.
struct GlowingPart {
    GlowingTriangle whole;
    std::uint32_t next = 0;  ///< the part after it and all of its own parts
    bool is_even = false;    ///< its texture counts as constant: it has no parts
};

/// Voxels of a volume that glow: around each of them light linear to the next ones along each axis.
struct GlowingVoxels {
    std::vector<glm::dvec3> centre;    ///< index coordinates
    std::vector<glm::dvec3> radiance;  ///< per metre at the centre [nit / m]
    glm::dmat4 to_scene{1};            ///< index coordinates to the scene [m]
    double volume = 0;                 ///< of a voxel [m^3]

    /// Power [lm] of one: 4 pi q V.
    glm::dvec3 power(std::size_t i) const;
};

/// What a lamp sends out.
struct LampSources {
    std::vector<GlowingTriangle> triangles;
    /// Where triangles are textured: all triangles, each before its parts, in the order of
    /// `triangles`, which are those that are even. Else empty.
    std::vector<GlowingPart> parts;
    std::vector<std::uint32_t> primitives;  ///< of Lamp
    std::vector<formats::Light> lights;
    GlowingVoxels voxels;
    /// Of the medium around it that particles scatter in [1/m], with similarity; 0: none. Straight
    /// light is dimmed by it.
    glm::dvec3 extinction{0};
    /// Sphere around all surfaces of the scene: directional lights shine on its square.
    glm::dvec3 centre{0};
    double radius = 0;

    bool empty() const { return triangles.empty() && lights.empty() && voxels.centre.empty(); }
};

/// Textured triangles are cut in four, over and over, until a part is no larger than a texel or its
/// texture is even, at most into 256 parts and all into about 65,000. Facets without area are left
/// out. `textures`: a part has the mean of its texture; null: the value at its middle.
LampSources make_lamp_sources(const formats::Scene& scene, const Lamp& lamp,
                              const ScenePyramids* textures = nullptr);

/// Power [lm] of a light; of a directional one that which falls on the square around the scene.
glm::dvec3 light_power(const LampSources& sources, const formats::Light& light);

}  // namespace opaline::bake
