#pragma once

#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/multiple/walks/walk.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Starts of walks at first scatterings inside the body: one below each site of the surface, its
/// direction that of uniform light that enters, its depth that of a first collision before the
/// next surface. Directions and depths are spread evenly over neighbouring sites (a rank-1
/// lattice); `sites` are in kd-order. Incomplete if the context is cancelled.
std::vector<WalkStart> make_inner_starts(const WalkSpace& space,
                                         std::span<const SurfaceSample> sites,
                                         const Context& context);

}  // namespace opaline::bake
