#pragma once

#include <glm/glm.hpp>

#include "formats/scene.h"

namespace opaline::bake {

/// The colour of veined stone at a world position [m], each band in [0, 1] for every finite
/// position.
///
///     q = position / scale
///     t = sum_{o = 0..4} 2^-o |n(2^o q / 2 + s_o)|       turbulence of gradient noise n
///     u = a . q + 2 t                                    a: unit vector across the veins
///     colour = ramp of `colors` at |sin(pi u)|           0 within a vein, 1 halfway between two
///
/// after the solid textures of [Perlin1985]; n is gtc/noise of GLM, in [-1, 1], s_o are fixed
/// offsets that keep the zeros of the octaves apart. n repeats after 289 units. Details finer than
/// the spacing of the vertices are lost.
formats::Rgb marble_color(const formats::Marble& marble, glm::dvec3 position);

}  // namespace opaline::bake
