// ElementLayout::join.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bake/exchange/lamps/surface_elements.h"

namespace opaline::bake {
namespace {

// Sizes of groups over those of footprints: 4^-1/12, 4^1/4, 4^7/12.
constexpr std::array<double, 3> kSizes{0.8908987181403393, 1.4142135623730951, 2.244924096618746};
constexpr std::size_t kMiddle = 1;

/// A part of a surface: the power it received, and whether it is joined to one value so far.
struct Joined {
    ElementDeposit deposit;
    double area = 0;
    bool is_whole = true;

    void add(const Joined& part) {
        deposit.power += part.deposit.power;
        deposit.weight += part.deposit.weight;
        deposit.weight_squares += part.deposit.weight_squares;
        deposit.log_footprint += part.deposit.log_footprint;
        area += part.area;
        is_whole = is_whole && part.is_whole;
    }
    bool joins(double size, double particles) const {
        return !(deposit.weight > 0) ||
               deposit.weight * deposit.weight < particles * deposit.weight_squares ||
               std::log(area / size) * deposit.weight <= deposit.log_footprint;
    }
    glm::vec3 irradiance() const {
        return area > 0 ? glm::vec3(deposit.power / area) : glm::vec3(0);
    }
};

}  // namespace

/// One pass over all elements.
class ElementLayout::Joining {
  public:
    Joining(const ElementLayout& layout, std::span<const ElementDeposit> deposits,
            const JoinRule& rule, double size)
        : light{std::vector<glm::vec3>(layout.size_), std::vector<std::uint32_t>(layout.size_)},
          layout_(layout),
          deposits_(deposits),
          size_(rule.share * size),
          particles_(rule.particles) {}

    Joined join_cluster(std::uint32_t primitive, std::uint32_t side,
                        const TriangleCluster& cluster) {
        const TriangleClusters& tree = layout_.clusters_[primitive];
        const auto hierarchy_of = [&](std::uint32_t i) -> const Hierarchy& {
            return layout_.hierarchies_[layout_.first_[primitive] +
                                        tree.order[i] * layout_.sides_[primitive] + side];
        };
        if (cluster.count == 1) return join_triangle(hierarchy_of(cluster.first), 0, 0);
        Joined joined = join_cluster(primitive, side, cluster.half(false));
        joined.add(join_cluster(primitive, side, cluster.half(true)));
        joined.is_whole = joined.is_whole && tree.joins(cluster) && joined.joins(size_, particles_);
        if (joined.is_whole) {
            const std::uint32_t first = hierarchy_of(cluster.first).first;
            for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
                const Hierarchy& hierarchy = hierarchy_of(i);
                fill(hierarchy.first, 1u << (2 * hierarchy.levels), first, joined);
            }
        }
        return joined;
    }

    ElementLight light;

  private:
    Joined join_triangle(const Hierarchy& hierarchy, std::uint32_t level, std::uint32_t index) {
        Joined joined;
        if (level == hierarchy.levels) {
            const std::uint32_t element = hierarchy.first + index;
            joined = {deposits_[element], std::ldexp(hierarchy.area, -2 * static_cast<int>(level)),
                      true};
            fill(element, 1, element, joined);
            return joined;
        }
        for (std::uint32_t child = 0; child < 4; ++child) {
            joined.add(join_triangle(hierarchy, level + 1, 4 * index + child));
        }
        joined.is_whole = joined.is_whole && joined.joins(size_, particles_);
        if (joined.is_whole) {
            const std::uint32_t within = 1u << (2 * (hierarchy.levels - level));
            const std::uint32_t first = hierarchy.first + index * within;
            fill(first, within, first, joined);
        }
        return joined;
    }

    // Elements first ... first + count - 1 have one value.
    void fill(std::uint32_t first, std::uint32_t count, std::uint32_t together,
              const Joined& joined) {
        std::fill_n(light.irradiance.begin() + first, count, joined.irradiance());
        std::fill_n(light.together.begin() + first, count, together);
    }

    const ElementLayout& layout_;
    std::span<const ElementDeposit> deposits_;
    double size_, particles_;
};

ElementLight ElementLayout::join(std::span<const ElementDeposit> deposits,
                                 const JoinRule& rule) const {
    ElementLight light{std::vector<glm::vec3>(size_, glm::vec3(0)), {}};
    for (std::size_t k = 0; k < kSizes.size(); ++k) {
        Joining joining(*this, deposits, rule, kSizes[k]);
        for (std::uint32_t primitive = 0; primitive < clusters_.size(); ++primitive) {
            for (std::uint32_t side = 0; side < sides_[primitive]; ++side) {
                for (const TriangleCluster& chart : clusters_[primitive].charts) {
                    joining.join_cluster(primitive, side, chart);
                }
            }
        }
        for (std::size_t i = 0; i < size_; ++i) {
            light.irradiance[i] += joining.light.irradiance[i] / static_cast<float>(kSizes.size());
        }
        if (k == kMiddle) light.together = std::move(joining.light.together);
    }
    return light;
}

}  // namespace opaline::bake
