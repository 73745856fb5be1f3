#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Cuts points into `most` patches, or as many as there are points: each time in halves along the
/// axis, of place or of normal, in which they differ most. The patch of each point. The two faces
/// of a thin wall are apart.
std::vector<std::uint32_t> cut_into_patches(std::span<const BodyPoint> points, std::size_t most);

}  // namespace opaline::bake
