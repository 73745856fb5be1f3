#pragma once

#include "bake/plan/stage_work.h"
#include "bake/scattering/half_space_medium.h"

namespace opaline::bake {

/// Seconds of a random walk through a body: a flight and what ends it.
inline constexpr CostBySize kBodyEvent{2.4e-7, 2.8e-7};

/// Random walks that find the reflectance of a medium (half_space_reflectance), all bands.
inline Work walk_work(const formats::Medium& medium) {
    constexpr double kEvent = 5.6e-8;
    return {0, count_walk_events(medium) * kEvent};
}

}  // namespace opaline::bake
