#include "bake/effects/multiple/walks/first_flight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

using PerGroup = std::array<float, 3>;

class FlightTracer {
  public:
    FlightTracer(const WalkSpace& space, FirstFlight& nodes)
        : space_(space), groups_(space.bands.size()), nodes_(nodes) {
        for (std::size_t g = 0; g < groups_; ++g) {
            sigma_t_ += space.media.front().sigma_t[g] / static_cast<float>(groups_);
        }
    }

    // What of a view's light met neither the medium nor its boundary.
    struct Rest {
        float lost = 0;      // through a hole; mean of the groups
        PerGroup unknown{};  // that, and what met another material
    };
    // `next`: what the view meets first.
    Rest follow(glm::vec3 position, glm::vec3 direction, int shells, std::uint32_t view,
                std::optional<WalkHit> next) {
        constexpr int kMostSurfaces = 16;
        constexpr float kLeast = 1e-3f;
        PerGroup left{1, 1, 1};
        for (int i = 0; i < kMostSurfaces; ++i) {
            if (!next) {
                scatter_along(position, direction, to_box(position, direction), view, left);
                return {mean(left), left};
            }
            const WalkHit hit = *next;
            const float way = glm::distance(hit.position, position);
            if (!hit.is_own) {
                // A surface inside the body or, through a hole, far away.
                const float box = to_box(position, direction);
                scatter_along(position, direction, std::min(way, box), view, left);
                return {way > box ? mean(left) : 0, left};
            }
            scatter_along(position, direction, way, view, left);
            const float side = glm::dot(direction, hit.flat) > 0 ? 1.0f : -1.0f;
            shells -= static_cast<int>(side);
            if (shells > 0) {
                position = hit.position + side * 2 * hit.error * hit.flat;
            } else {
                shells = 1;
                if (!reflect(hit, position, direction, left) || mean(left) < kLeast) {
                    return {};
                }
            }
            next.emplace();
            if (!find_hit(space_, position, direction, std::numeric_limits<float>::infinity(),
                          *next)) {
                next.reset();
            }
        }
        return {};
    }

  private:
    float mean(const PerGroup& values) const {
        float sum = 0;
        for (std::size_t g = 0; g < groups_; ++g) {
            sum += values[g] / static_cast<float>(groups_);
        }
        return sum;
    }

    float to_box(glm::vec3 position, glm::vec3 direction) const {
        float distance = std::numeric_limits<float>::max();
        for (int axis = 0; axis < 3; ++axis) {
            if (direction[axis] != 0) {
                const float wall = direction[axis] > 0 ? space_.high[axis] : space_.low[axis];
                distance = std::min(distance, (wall - position[axis]) / direction[axis]);
            }
        }
        return std::max(0.0f, distance);
    }

    // Collisions up to `distance`: Gauss's rule over v = e^(-sigma_t s / 2), which holds light that
    // grows with the depth s as well as light that decays.
    void scatter_along(glm::vec3 position, glm::vec3 direction, float distance, std::uint32_t view,
                       PerGroup& left) {
        constexpr std::array<float, 4> kNode{0.0694318442f, 0.3300094782f, 0.6699905218f,
                                             0.9305681558f};
        constexpr std::array<float, 4> kWeight{0.1739274226f, 0.3260725774f, 0.3260725774f,
                                               0.1739274226f};
        const WalkMedium& medium = space_.media.front();
        const float range = -std::expm1(-0.5f * sigma_t_ * distance);  // of v: 1 - range to 1
        std::array<FlightNode, kNode.size()> nodes;
        PerGroup sum{};
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const float depth = -2 * std::log1p(-range * kNode[i]) / sigma_t_;
            nodes[i] = {position + std::min(depth, distance) * direction, direction, {}, view};
            for (std::size_t g = 0; g < groups_; ++g) {
                // sigma_t e^(-sigma_t s) ds in proportion
                nodes[i].weight[g] =
                    kWeight[i] * std::exp((0.5f * sigma_t_ - medium.sigma_t[g]) * depth);
                sum[g] += nodes[i].weight[g];
            }
        }
        for (std::size_t g = 0; g < groups_; ++g) {
            const float scattered = -std::expm1(-medium.sigma_t[g] * distance);
            for (FlightNode& node : nodes) {
                node.weight[g] *= sum[g] > 0 ? left[g] * scattered / sum[g] : 0;
            }
            left[g] *= 1 - scattered;
        }
        nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
    }

    // At the boundary, from inside, as walks are.
    bool reflect(const WalkHit& hit, glm::vec3& position, glm::vec3& direction,
                 PerGroup& left) const {
        const glm::vec3 normal = inner_boundary_normal(space_, hit, direction);
        const float cosine = std::min(1.0f, glm::dot(direction, normal));
        const auto reflected = static_cast<float>(
            fresnel_reflectance(static_cast<double>(cosine), 1 / static_cast<double>(space_.eta)));
        for (float& value : left) {
            value *= reflected;
        }
        position = hit.position - 2 * hit.error * hit.flat;
        direction = glm::normalize(direction - 2 * glm::dot(direction, normal) * normal);
        return reflected > 0;
    }

    const WalkSpace& space_;
    std::size_t groups_;
    float sigma_t_ = 0;  // mean of the groups
    FirstFlight& nodes_;
};

// Beside a sharp edge half of all views leave the body after next to no way. What scatters on that
// way is as bright as what they would see with more of the medium before them.
void fill_crossed(std::span<FlightNode> nodes, const PerGroup& unknown) {
    PerGroup scattered{};
    for (const FlightNode& node : nodes) {
        for (std::size_t g = 0; g < scattered.size(); ++g) {
            scattered[g] += node.weight[g];
        }
    }
    for (FlightNode& node : nodes) {
        for (std::size_t g = 0; g < scattered.size(); ++g) {
            node.weight[g] *= scattered[g] > 0 ? (1 - unknown[g]) / scattered[g] : 0;
        }
    }
}

}  // namespace

FirstFlight trace_first_flight(const WalkSpace& space, const ViewSet& views, const BodyPoint& point,
                               bool fills_crossed) {
    FirstFlight nodes;
    const int shells = std::max(1, count_shells(space, point.inner, -point.normal));
    FlightTracer tracer(space, nodes);
    const std::vector<std::optional<WalkHit>> first = find_hits(space, point.inner, views.into);
    float lost = 0;
    for (std::uint32_t v = 0; v < views.into.size(); ++v) {
        const std::size_t before = nodes.size();
        const FlightTracer::Rest rest =
            tracer.follow(point.inner, views.into[v], shells, v, first[v]);
        lost += views.share[v][0] * rest.lost;
        if (fills_crossed || (first[v] && is_around_vertex(space, *first[v], point.position))) {
            fill_crossed(std::span(nodes).subspan(before), rest.unknown);
        }
    }
    if (lost > 0 && lost < 0.5f) {
        for (FlightNode& node : nodes) {
            for (float& weight : node.weight) {
                weight /= 1 - lost;
            }
        }
    }
    return nodes;
}

}  // namespace opaline::bake
