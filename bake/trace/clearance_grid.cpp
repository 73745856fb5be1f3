#include "bake/trace/clearance_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace opaline::bake {
namespace {

constexpr float kStepsPerCell = 4;
constexpr std::uint8_t kMostSteps = 255;
constexpr float kFar = 4e6f;  // squared cells: above the diagonal's; sums with it are exact

// Replaces f(i), 0 to kFar, by the least f(j) + (i - j)^2: of the envelope of these parabolas
// [Felzenszwalb2012].
class LowerEnvelope {
  public:
    void replace(std::vector<float>& f) {
        const std::size_t n = f.size();
        middle_.resize(n);
        begin_.resize(n + 1);
        std::size_t last = 0;
        middle_[0] = 0;
        begin_[0] = -std::numeric_limits<float>::infinity();
        const auto height = [&](std::size_t i) {
            return f[i] + static_cast<float>(i) * static_cast<float>(i);
        };
        for (std::size_t i = 1; i < n; ++i) {
            float crossing = 0;
            for (;; --last) {
                const std::size_t j = middle_[last];
                crossing = (height(i) - height(j)) / (2 * static_cast<float>(i - j));
                if (crossing > begin_[last]) break;
            }
            middle_[++last] = i;
            begin_[last] = crossing;
        }
        begin_[last + 1] = std::numeric_limits<float>::infinity();
        least_.resize(n);
        for (std::size_t i = 0, k = 0; i < n; ++i) {
            while (begin_[k + 1] < static_cast<float>(i)) {
                ++k;
            }
            const float way = static_cast<float>(i) - static_cast<float>(middle_[k]);
            least_[i] = f[middle_[k]] + way * way;
        }
        f.swap(least_);
    }

  private:
    std::vector<std::size_t> middle_;
    std::vector<float> begin_, least_;
};

}  // namespace

ClearanceGrid::ClearanceGrid(const formats::Scene& scene, glm::vec3 centre, glm::vec3 half_size,
                             float cell, std::uint32_t most) {
    const float longest = 2 * std::max({half_size.x, half_size.y, half_size.z});
    cell_ = std::max(cell, longest / static_cast<float>(most - 2));
    if (!(cell_ > 0) || longest < 8 * cell_) return;
    per_cell_ = 1 / cell_;
    step_ = cell_ / kStepsPerCell;
    // A margin of half a cell keeps rounded positions inside.
    size_ = glm::uvec3(glm::ceil(2.0f * half_size * per_cell_)) + 1u;
    count_ = glm::vec3(size_);
    low_ = centre - 0.5f * cell_ * count_;
    clear_.assign(std::size_t{size_.x} * size_.y * size_.z, kMostSteps);
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
            if (visits > kMostVisits) return false;
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

// Least distances between any points of a cell and of a marked one, squared: along each axis
// max(0, |d| - 1)^2 for cells d apart. As a sum over axes it is minimised along one after the
// other.
void ClearanceGrid::measure_distances() {
    std::vector<float> square(clear_.size());
    for (std::size_t i = 0; i < clear_.size(); ++i) {
        square[i] = clear_[i] == 0 ? 0 : kFar;
    }
    for (int axis = 0; axis < 3; ++axis) {
        measure_along(axis, square);
    }
    for (std::size_t i = 0; i < clear_.size(); ++i) {
        clear_[i] = static_cast<std::uint8_t>(
            std::min(static_cast<float>(kMostSteps), kStepsPerCell * std::sqrt(square[i])));
    }
}

void ClearanceGrid::measure_along(int axis, std::vector<float>& square) const {
    const std::array<std::size_t, 3> step{1, size_.x, std::size_t{size_.x} * size_.y};
    const auto a = static_cast<std::size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
    const auto size = [&](std::size_t i) { return std::size_t{size_[static_cast<int>(i)]}; };
    LowerEnvelope envelope;
    std::vector<float> line(size(a));
    for (std::size_t j = 0; j < size(c); ++j) {
        for (std::size_t k = 0; k < size(b); ++k) {
            float* const first = &square[j * step[c] + k * step[b]];
            const auto at = [&](std::size_t i) -> float& { return first[i * step[a]]; };
            // (|d| - 1)^2 is d^2 from the nearer of the cell's neighbours and itself.
            for (std::size_t i = 0; i < line.size(); ++i) {
                line[i] =
                    std::min({at(i > 0 ? i - 1 : 0), at(i), at(std::min(i + 1, line.size() - 1))});
            }
            envelope.replace(line);
            for (std::size_t i = 0; i < line.size(); ++i) {
                at(i) = line[i];
            }
        }
    }
}

}  // namespace opaline::bake
