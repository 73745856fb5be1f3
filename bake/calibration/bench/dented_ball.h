#pragma once

#include <cstdint>

#include "formats/scene.h"

namespace opaline::bake {

/// The calibration scene: a ball of radius 1 m with dents that shadow each other. Its one material
/// is a medium with a mean free path of 1/200 of the diameter. 12 n n triangles on six grids of (n
/// + 1)^2 vertices, closed. `n` >= 1.
formats::Scene make_dented_ball(std::uint32_t n);

}  // namespace opaline::bake
