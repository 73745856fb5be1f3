#pragma once

#include "bake/plan/stage_work.h"
#include "bake/scattering/half_space_medium.h"

namespace opaline::bake {

/// Random walks that find the reflectance of a medium (half_space_reflectance), all bands.
inline Work walk_work(const CostInput& input, const formats::Medium& medium) {
    return {0, count_walk_events(medium) * input.rates.walk_event};
}

}  // namespace opaline::bake
