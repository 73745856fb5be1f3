#pragma once

#include <cstdint>

#include "formats/scene.h"

namespace opaline::bake {

/// What a machine is measured with: a ball of radius 1 [m] whose dents shadow each other, of one
/// material, a medium whose mean free path is a two-hundredth of the diameter. 12 n n triangles on
/// six grids of (n + 1)^2 vertices, closed. `n` >= 1.
formats::Scene make_dented_ball(std::uint32_t n);

}  // namespace opaline::bake
