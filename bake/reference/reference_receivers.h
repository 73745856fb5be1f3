#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bake/reference/path.h"

namespace opaline::bake {

/// `wanted` vertices of the scene, stratified over all primitives and drawn by the seed; all
/// vertices, in order, if there are no more. `eye` [m, world]: point of view; nothing: each along
/// its own normal.
std::vector<ReferenceReceiver> choose_receivers(const ReferenceScene& scene, std::uint32_t wanted,
                                                std::uint64_t seed,
                                                const std::optional<glm::vec3>& eye);

}  // namespace opaline::bake
