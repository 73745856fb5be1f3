#pragma once

#include <cstdint>

#include "formats/scene.h"

namespace opaline::bake {

/// How a material's base colour varies over its surfaces.
struct ColorRange {
    float brightest_vertex =
        0;  ///< largest component of its vertex colours; 1 where there are none
    /// Largest difference between two places, of any component: vertex colour times texture times
    /// veins. 0: constant. Texels count whether or not a triangle shows them.
    float contrast = 0;
};
ColorRange find_color_range(const formats::Scene& scene, std::uint32_t material);

}  // namespace opaline::bake
