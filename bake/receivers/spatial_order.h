#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace opaline::bake {

/// The indices of `positions` along a space-filling curve (Morton order of a grid of 2^10 cells
/// across their bounding box), so that neighbours in space are neighbours in memory. Equal cells
/// keep their order. Non-finite positions may land anywhere.
std::vector<std::uint32_t> spatial_order(std::span<const glm::vec3> positions);

}  // namespace opaline::bake
