#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Of the rays and clusters of all rows of `cost.receivers` receivers.
Work bounce_rows_work(const SubjectCost& cost);

/// Of scatterers and their light, media left out.
LightWork bounce_light_work(const CostInput& input);

}  // namespace opaline::bake
