#include "bake/receivers/surface_patches.h"

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>
#include <utility>

namespace opaline::bake {
namespace {

// Place, in shares of all points' extent, and normal: opposite faces are half of that apart.
std::array<float, 6> coordinates(const BodyPoint& point, float extent) {
    constexpr float kNormals = 0.25f;
    const glm::vec3 p = point.position / extent, n = kNormals * point.normal;
    return {p.x, p.y, p.z, n.x, n.y, n.z};
}

struct Cutter {
    std::span<const std::array<float, 6>> at;
    std::vector<std::uint32_t>& patch;
    std::uint32_t made = 0;

    void cut(std::span<std::uint32_t> members, std::size_t parts) {
        if (parts <= 1 || members.size() <= 1) {
            for (const std::uint32_t i : members) {
                patch[i] = made;
            }
            made += members.empty() ? 0 : 1;
            return;
        }
        std::size_t widest = 0;
        float most = -1;
        for (std::size_t axis = 0; axis < 6; ++axis) {
            float low = std::numeric_limits<float>::max(), high = -low;
            for (const std::uint32_t i : members) {
                low = std::min(low, at[i][axis]);
                high = std::max(high, at[i][axis]);
            }
            if (high - low > most) {
                most = high - low;
                widest = axis;
            }
        }
        const std::size_t left = parts / 2;
        const std::size_t middle =
            std::clamp<std::size_t>(members.size() * left / parts, 1, members.size() - 1);
        std::ranges::nth_element(members, members.begin() + static_cast<std::ptrdiff_t>(middle), {},
                                 [&](std::uint32_t i) { return std::pair(at[i][widest], i); });
        cut(members.first(middle), left);
        cut(members.subspan(middle), parts - left);
    }
};

}  // namespace

std::vector<std::uint32_t> cut_into_patches(std::span<const BodyPoint> points, std::size_t most) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const BodyPoint& point : points) {
        low = glm::min(low, point.position);
        high = glm::max(high, point.position);
    }
    const float extent = points.empty() ? 1 : std::max(glm::length(high - low), 1e-30f);
    std::vector<std::array<float, 6>> at;
    at.reserve(points.size());
    for (const BodyPoint& point : points) {
        at.push_back(coordinates(point, extent));
    }
    std::vector<std::uint32_t> patch(points.size()), members(points.size());
    std::iota(members.begin(), members.end(), 0u);
    Cutter{at, patch}.cut(members, std::min(most, points.size()));
    return patch;
}

}  // namespace opaline::bake
