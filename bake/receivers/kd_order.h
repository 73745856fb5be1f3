#pragma once

#include <cstdint>
#include <vector>

#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Neighbours that gather together: one for each lane of a ray packet.
constexpr std::uint32_t kSamplesPerGroup = 16;

/// Sorts samples so that each run of kSamplesPerGroup from the first on is a node of a kd-tree
/// (split where the longest side has half of the groups on either hand); the last may have fewer.
void sort_into_groups(std::vector<SurfaceSample>& samples);

}  // namespace opaline::bake
