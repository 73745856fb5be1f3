#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bake/receivers/surface_points.h"

namespace opaline::bake {

/// Normals more than 120 degrees apart belong to different sides of a sheet. Normals at the edge of
/// a box are 90 degrees apart.
inline bool on_same_side(glm::vec3 normal_a, glm::vec3 normal_b) {
    return glm::dot(normal_a, normal_b) > -0.5f;
}

/// Points in cubic cells.
class PointGrid {
  public:
    PointGrid(const std::vector<SurfacePoint>& points, float cell) : cell_(cell) {
        std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
        keyed.reserve(points.size());
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            keyed.emplace_back(cell_of(points[i].position), i);
        }
        std::sort(keyed.begin(), keyed.end());
        order_.reserve(points.size());
        for (const auto& [key, i] : keyed) {
            if (order_.empty() || keys_.back() != key) {
                place_.emplace(key, static_cast<std::uint32_t>(keys_.size()));
                keys_.push_back(key);
                first_.push_back(static_cast<std::uint32_t>(order_.size()));
            }
            order_.push_back(i);
        }
        first_.push_back(static_cast<std::uint32_t>(order_.size()));
    }

    std::size_t cells() const { return keys_.size(); }

    /// Points of a cell in 0 ... cells() - 1.
    std::span<const std::uint32_t> points_in(std::size_t cell) const {
        return std::span(order_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
    }

    /// All points of the 27 cells around cell `key` (cell_of).
    void collect_around(std::uint64_t key, std::vector<std::uint32_t>& around) const {
        around.clear();
        for (std::uint64_t k = 0; k < 27; ++k) {
            const std::uint64_t neighbour =
                pack(unpack(key, 0) + k % 3, unpack(key, 1) + k / 3 % 3, unpack(key, 2) + k / 9);
            const auto found = place_.find(neighbour);
            if (found != place_.end()) {
                const auto points = points_in(found->second);
                around.insert(around.end(), points.begin(), points.end());
            }
        }
    }

    /// Key of the cell that holds a position.
    std::uint64_t cell_of(glm::vec3 position) const {
        const glm::ivec3 c(glm::floor(position / cell_));
        return pack(static_cast<std::uint64_t>(c.x) + 1, static_cast<std::uint64_t>(c.y) + 1,
                    static_cast<std::uint64_t>(c.z) + 1);
    }
    std::uint64_t name_of(std::size_t cell) const { return keys_[cell]; }
    /// The cell of that key, 0 ... cells() - 1; cells() where it holds no point.
    std::size_t cell_at(std::uint64_t key) const {
        const auto found = place_.find(key);
        return found != place_.end() ? found->second : cells();
    }

  private:
    // Coordinates wrap around. `pack` expects them one too large, so that neighbours are +0, +1,
    // +2.
    static constexpr std::uint64_t kBits = 21, kMask = (std::uint64_t{1} << kBits) - 1;
    static std::uint64_t pack(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
        return ((x - 1) & kMask) | ((y - 1) & kMask) << kBits | ((z - 1) & kMask) << (2 * kBits);
    }
    static std::uint64_t unpack(std::uint64_t key, std::uint64_t axis) {
        return key >> (axis * kBits) & kMask;
    }

    float cell_;
    std::vector<std::uint32_t> order_;  // points, cell by cell
    std::vector<std::uint64_t> keys_;   // of the cells, ascending
    std::vector<std::uint32_t> first_;  // cells + 1, into order_
    std::unordered_map<std::uint64_t, std::uint32_t> place_;
};

}  // namespace opaline::bake
