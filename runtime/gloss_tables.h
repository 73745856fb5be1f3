#pragma once

#include <vector>

#include "formats/opal/environment.h"
#include "runtime/gloss_light.h"

namespace opaline::runtime {

/// Cell of gloss.glsl, eight floats each.
inline std::vector<float> make_cell_table(const GlossLight& light) {
    const GlossLight::Cells& c = light.cells;
    std::vector<float> table;
    table.reserve(8 * c.size());
    for (std::size_t i = 0; i < c.size(); ++i) {
        table.insert(table.end(), {c.x[i], c.y[i], c.z[i], c.solid_angle[i], c.r[i], c.g[i], c.b[i],
                                   c.widening[i]});
    }
    return table;
}

/// Sun of gloss.glsl, eight floats each.
inline std::vector<float> make_sun_table(const GlossLight& light) {
    std::vector<float> table;
    table.reserve(8 * light.suns.size());
    for (const formats::DistantDisc& sun : light.suns) {
        table.insert(table.end(),
                     {sun.direction.x, sun.direction.y, sun.direction.z, sun.angular_radius,
                      sun.radiance.r, sun.radiance.g, sun.radiance.b,
                      static_cast<float>(formats::disc_solid_angle(sun.angular_radius))});
    }
    return table;
}

}  // namespace opaline::runtime
