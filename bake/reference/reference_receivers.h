#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bake/reference/path.h"

namespace opaline::bake {

/// `wanted` of the scene's vertices, spread evenly over all primitives and drawn by the seed; all
/// of them, in order, if there are no more.
/// `eye` [m, world]: where they are seen from; nothing: each along its own normal.
std::vector<ReferenceReceiver> choose_receivers(const ReferenceScene& scene, std::uint32_t wanted,
                                                std::uint64_t seed,
                                                const std::optional<glm::vec3>& eye);

}  // namespace opaline::bake
