#include "tests/bench/gl_parity/skies.h"

#include <cmath>

#include "tests/runtime/embed_gl/host/host_context.h"

namespace opaline::parity {

using test::require;

void Sky::light(opaline_light* light) const {
    require(opaline_light_clear(light) == OPALINE_OK &&
                opaline_light_set_rotation(light, world_from_light.data()) == OPALINE_OK &&
                opaline_light_set_lat_long(light, map.data(), width, height) == OPALINE_OK,
            opaline_last_error());
    for (const opaline_layer_sun& sun : suns) {
        require(opaline_light_add_sun(light, sun.direction, sun.angular_radius, sun.radiance) ==
                    OPALINE_OK,
                opaline_last_error());
    }
}

opaline_layer_sky Sky::of_layer() const {
    opaline_layer_sky sky{};
    sky.struct_size = sizeof sky;
    sky.time = 100;
    sky.map = map.data();
    sky.width = width;
    sky.height = height;
    sky.suns = suns.data();
    sky.sun_count = static_cast<std::uint32_t>(suns.size());
    sky.world_from_light = world_from_light.data();
    return sky;
}

Sky even_sky() {
    return {{1, 0.8f, 0.5f}, 1, 1, {{{1, 2, 0.5f}, 0.02f, {900, 800, 700}}}};
}

Sky varied_sky() {
    Sky sky{{},
            64,
            32,
            {{{-1, 1.2f, -1}, 0.01f, {9000, 8000, 3000}}, {{0.1f, 0.5f, 1}, 0.05f, {30, 60, 90}}},
            {0, 0, -1, 0.6f, 0.8f, 0, 0.8f, -0.6f, 0}};
    for (std::uint32_t i = 0; i < sky.width * sky.height; ++i) {
        const float x = static_cast<float>(i % sky.width) / 64;
        const float y = static_cast<float>(i / sky.width) / 32;
        const float spot = i % 397 == 5 ? 40.0f : 0.0f;
        sky.map.insert(sky.map.end(),
                       {0.2f + x + spot, 1 - y + 0.5f * spot, 0.5f + 0.5f * std::sin(9 * x) * y});
    }
    return sky;
}

}  // namespace opaline::parity
