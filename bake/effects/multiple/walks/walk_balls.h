#pragma once

#include <cstdint>

#include "bake/base/context.h"
#include "bake/effects/multiple/walks/walk_space.h"

namespace opaline::bake {

/// Radius [mean free paths] of the largest useful balls in a medium: at most an eighth of the
/// body's diagonal, `size` [mean free paths], and the distance that light reaches before it is
/// absorbed; 0 where balls save no time (README.md, "Balls"). `g`: the mean cosine.
double largest_ball(double albedo, double g, double size);

/// Gives a space banks of balls for its media that do not vary, and a finer grid of clearances.
/// Media with the same phase function share a bank. Not where as few walks as `walks` would save no
/// more than banks cost. No walk's mean changes. No balls if the context is cancelled.
void add_balls(WalkSpace& space, double walks, std::uint64_t seed, const Context& context);

}  // namespace opaline::bake
