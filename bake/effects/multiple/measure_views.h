#pragma once

#include <cstdint>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/plan/effect.h"

namespace opaline::bake {

/// What one row for all views leaves of light of all orders: relative RMS over vertices, views and
/// lights.
struct ViewErrors {
    double one = 0;
    std::uint32_t receivers = 0;  ///< 0: nothing was measured
};

/// Walks from 16 vertices along the views from which rows follow (ViewSet), under
/// make_pilot_lights. A quarter of the weight is on the normal, as in the self-check. Errors below
/// 3 % drown in noise and are 0. `traced` adds up.
ViewErrors measure_views(const EffectInputs& inputs, const MediumProfile& profile,
                         std::uint64_t& traced);

}  // namespace opaline::bake
