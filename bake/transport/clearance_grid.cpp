#include "bake/transport/clearance_grid.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

constexpr std::uint32_t kMostCells = 128;  // along a side: steps fit into a byte

}  // namespace

ClearanceGrid::ClearanceGrid(const formats::Scene& scene, glm::vec3 centre, glm::vec3 half_size,
                             float cell) {
    const float longest = 2 * std::max({half_size.x, half_size.y, half_size.z});
    cell_ = std::max(cell, longest / (kMostCells - 2));
    if (!(cell_ > 0) || longest < 8 * cell_) {
        return;
    }
    per_cell_ = 1 / cell_;
    // A margin of half a cell keeps rounded positions inside.
    size_ = glm::uvec3(glm::ceil(2.0f * half_size * per_cell_)) + 1u;
    count_ = glm::vec3(size_);
    low_ = centre - 0.5f * cell_ * count_;
    clear_.assign(std::size_t{size_.x} * size_.y * size_.z, std::uint8_t{kMostCells});
    if (!mark_triangles(scene)) {
        *this = {};
        return;
    }
    measure_distances();
}

// Sets 0 in all cells that a triangle touches, and in some cells near it. Returns false, with the
// grid incomplete, if large triangles visit more than kMostVisits cells.
bool ClearanceGrid::mark_triangles(const formats::Scene& scene) {
    constexpr float kRounding = 1e-3f;                             // of a cell
    constexpr std::uint64_t kMostVisits = std::uint64_t{1} << 28;  // a second or so
    std::uint64_t visits = 0;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            const auto place = [&](std::size_t k) {
                return (p.position[p.index[i + k]] - low_) * per_cell_;
            };
            const glm::vec3 a = place(0), b = place(1), c = place(2);
            const glm::vec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
            if (glm::any(glm::greaterThan(low - kRounding, count_)) ||
                glm::any(glm::lessThan(high + kRounding, glm::vec3(0)))) {
                continue;  // outside the box
            }
            const glm::vec3 n = glm::cross(b - a, c - a);
            const glm::uvec3 first =
                glm::min(glm::uvec3(glm::max(low - kRounding, 0.0f)), size_ - 1u);
            const glm::uvec3 last =
                glm::uvec3(glm::clamp(high + kRounding, glm::vec3(0), count_ - 1.0f));
            // The plane cuts the cell if the centre's distance to it is at most the projected half
            // diagonal.
            const glm::vec3 across = glm::abs(n);
            const glm::uvec3 extent = last - first + 1u;
            visits += std::uint64_t{extent.x} * extent.y * extent.z;
            if (visits > kMostVisits) {
                return false;
            }
            const float reach = (0.5f + kRounding) * (across.x + across.y + across.z);
            for (std::uint32_t z = first.z; z <= last.z; ++z) {
                for (std::uint32_t y = first.y; y <= last.y; ++y) {
                    for (std::uint32_t x = first.x; x <= last.x; ++x) {
                        const glm::vec3 centre = glm::vec3(x, y, z) + 0.5f;
                        if (std::abs(glm::dot(n, centre - a)) <= reach) {
                            clear_[index({x, y, z})] = 0;
                        }
                    }
                }
            }
        }
    }
    return true;
}

// Steps to the nearest marked cell, diagonal ones included, in two passes over all neighbours that
// precede and follow [Rosenfeld1968]; minus one step, because a point may be anywhere in its cell.
void ClearanceGrid::measure_distances() {
    const glm::ivec3 size(size_);
    const auto pass = [&](int direction) {
        for (int k = 0; k < size.z; ++k) {
            for (int j = 0; j < size.y; ++j) {
                for (int i = 0; i < size.x; ++i) {
                    const glm::ivec3 at =
                        direction > 0 ? glm::ivec3(i, j, k) : size - 1 - glm::ivec3(i, j, k);
                    std::uint8_t& own = clear_[index(glm::uvec3(at))];
                    for (int n = 0; n < 13 && own > 0; ++n) {
                        // The 13 of 27 neighbours before the middle.
                        const glm::ivec3 step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
                        const glm::ivec3 other = at + direction * step;
                        if (glm::all(glm::greaterThanEqual(other, glm::ivec3(0))) &&
                            glm::all(glm::lessThan(other, size))) {
                            const int through = clear_[index(glm::uvec3(other))] + 1;
                            own = static_cast<std::uint8_t>(std::min<int>(own, through));
                        }
                    }
                }
            }
        }
    };
    pass(1);
    pass(-1);
    for (std::uint8_t& steps : clear_) {
        steps = static_cast<std::uint8_t>(std::max(0, steps - 1));
    }
}

}  // namespace opaline::bake
