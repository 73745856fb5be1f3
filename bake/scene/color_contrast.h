#pragma once

#include <cstdint>

#include "bake/scene/scene_facts.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Variation of a material's base colour over its surfaces.
struct ColorRange {
    float brightest_vertex =
        0;  ///< largest component of its vertex colours; 1 where there are none
    /// Largest difference of any component between two positions: vertex colour times texture times
    /// veins. 0: constant. All texels count, also those that no triangle shows.
    float contrast = 0;
};
ColorRange find_color_range(const formats::Scene& scene, std::uint32_t material);

/// `brightest`: the material's largest albedo where its textures are white.
TextureFacts find_texture_facts(const formats::Scene& scene, std::uint32_t material,
                                double brightest);

}  // namespace opaline::bake
