#include "bake/exchange/even_choice.h"

#include <algorithm>
#include <numeric>

namespace opaline::bake {
namespace {

class EvenChoice {
  public:
    explicit EvenChoice(std::span<const SidePoint> points) : points_(points) {}

    // Appends `count` of the members, in [1, their number], to `chosen`.
    void choose(std::span<std::uint32_t> members, std::size_t count) {
        if (count == members.size()) {
            chosen.insert(chosen.end(), members.begin(), members.end());
            return;
        }
        glm::vec3 low(place(members[0])), high(low), sum(0);
        for (const std::uint32_t i : members) {
            low = glm::min(low, place(i));
            high = glm::max(high, place(i));
            sum += place(i);
        }
        if (count == 1) {
            const glm::vec3 middle = sum / static_cast<float>(members.size());
            chosen.push_back(*std::ranges::min_element(
                members, {}, [&](std::uint32_t i) { return glm::distance(place(i), middle); }));
            return;
        }
        const glm::vec3 extent = high - low;
        const glm::length_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                                   : extent.y >= extent.z                       ? 1
                                                                                : 2;
        const std::size_t left = count / 2, split = members.size() * left / count;
        std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(split),
                         members.end(), [&](std::uint32_t a, std::uint32_t b) {
                             const float x = place(a)[axis], y = place(b)[axis];
                             return x < y || (x == y && a < b);
                         });
        choose(members.first(split), left);
        choose(members.subspan(split), count - left);
    }

    std::vector<std::uint32_t> chosen;

  private:
    glm::vec3 place(std::uint32_t i) const { return points_[i].position; }

    std::span<const SidePoint> points_;
};

}  // namespace

std::vector<std::uint32_t> choose_evenly(std::span<const SidePoint> points, std::size_t count) {
    const std::size_t kept = std::min(count, points.size());
    std::vector<std::size_t> side(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SurfaceSide& own = points[i].side;
        side[i] = first_side_axis(own.material, own.behind) + nearest_side_axis(own.normal);
    }
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return side[i]; });
    EvenChoice choice(points);
    choice.chosen.reserve(kept);
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin;
        while (end < order.size() && side[order[end]] == side[order[begin]]) {
            ++end;
        }
        // Shares of a whole number that add up to it.
        const std::size_t share = end * kept / order.size() - begin * kept / order.size();
        if (share > 0) {
            choice.choose(std::span(order).subspan(begin, end - begin), share);
        }
        begin = end;
    }
    return choice.chosen;
}

}  // namespace opaline::bake
