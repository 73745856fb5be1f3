#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/lamps/lamp_sources.h"
#include "bake/lamps/surface_elements.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Light of lamps that media send out again, at the vertices of their surfaces.
struct MediaLight {
    /// Of each primitive: exitance [lm/m^2] without the base color's image, lamp * vertices +
    /// vertex. Empty: it is no medium, or sends out nothing.
    std::vector<std::vector<glm::vec3>> exitance;

    bool empty() const;
};

/// Exitance [lm/m^2] of a lamp's light at a point of a triangle's front, its image included; 0 from
/// behind and where the primitive emits nothing. `view`: footprint of the image's look-up; null: at
/// the point.
glm::dvec3 media_exitance(const formats::Scene& scene, const MediaLight& media, std::size_t lamp,
                          const TriangleSide& side, const glm::vec3& weights,
                          const TextureView* view = nullptr);

/// A lamp's light that leaves media, as evenly glowing triangles: the mean of their corners times
/// the mean of the image with `textures`, else its value at their middle. `lamp_sources`: for the
/// sphere around the scene.
LampSources media_sources(const formats::Scene& scene, const MediaLight& media, std::size_t lamp,
                          const LampSources& lamp_sources, const ScenePyramids* textures = nullptr);

}  // namespace opaline::bake
