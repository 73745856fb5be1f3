#include "bake/receivers/spatial_order.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace opaline::bake {
namespace {

// Spreads the ten lowest bits, two zero bits after each.
std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(std::span<const glm::vec3> positions) {
    glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
    for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low;
    constexpr float kLastCell = 1023.0f;
    const float largest = std::max({size.x, size.y, size.z});
    const float scale = largest > 0 ? kLastCell / largest : 0.0f;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> key;
    key.reserve(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        std::uint32_t code = 0;
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const float cell = scale * (positions[i][axis] - low[axis]);
            // This form of the comparison puts NaN into the first cell.
            const float clamped = cell > 0 ? std::min(cell, kLastCell) : 0.0f;
            code |= spread_bits(static_cast<std::uint32_t>(clamped)) << axis;
        }
        key.emplace_back(code, i);
    }
    std::sort(key.begin(), key.end());
    std::vector<std::uint32_t> order;
    order.reserve(key.size());
    for (const auto& [code, i] : key) {
        order.push_back(i);
    }
    return order;
}

}  // namespace opaline::bake
