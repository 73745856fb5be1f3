#pragma once

#include <functional>
#include <vector>

#include "bake/accuracy/sweep/ladders.h"

namespace opaline::bake {

/// 0 for presets, 1 for choices, which presets may have made, 3 for joint ladders, else 2.
int urgency(const SweepPoint& point);

/// Urgent points first, of those the cheap ones: they give the most information per second.
/// `seconds`: predicted; asked once for each point.
void order_points(std::vector<SweepPoint>& points,
                  const std::function<double(const SweepPoint&)>& seconds);

}  // namespace opaline::bake
