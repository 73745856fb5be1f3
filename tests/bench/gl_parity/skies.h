#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/opaline_gl.h"

namespace opaline::parity {

/// A light for whatever a file holds: a latitude-longitude map, suns and a rotation.
struct Sky {
    std::vector<float> map;
    std::uint32_t width = 0, height = 0;
    std::vector<opaline_layer_sun> suns;
    std::array<float, 9> world_from_light{1, 0, 0, 0, 1, 0, 0, 0, 1};

    /// As the light of surfaces and volumes. Throws as test::require.
    void light(opaline_light* light) const;
    /// As the light of a cloud layer; refers to this.
    opaline_layer_sky of_layer() const;
};

/// Even light with a sun in it.
Sky even_sky();
/// A turned map that differs everywhere and between bands, with small bright parts and two suns.
Sky varied_sky();

}  // namespace opaline::parity
