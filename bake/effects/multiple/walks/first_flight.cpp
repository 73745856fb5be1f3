#include "bake/effects/multiple/walks/first_flight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/scattering/fresnel.h"

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

    // The share of the view's light that is lost through a hole.
    float follow(glm::vec3 position, glm::vec3 direction, int shells, std::uint32_t view) {
        constexpr int kMostSurfaces = 16;
        constexpr float kLeast = 1e-3f;
        PerGroup left{1, 1, 1};
        for (int i = 0; i < kMostSurfaces; ++i) {
            WalkHit hit;
            if (!find_hit(space_, position, direction, std::numeric_limits<float>::infinity(),
                          hit)) {
                scatter_along(position, direction, to_box(position, direction), view, left);
                return mean(left);
            }
            if (!hit.is_own) {
                return 0;
            }
            scatter_along(position, direction, glm::distance(hit.position, position), view, left);
            const float side = glm::dot(direction, hit.flat) > 0 ? 1.0f : -1.0f;
            shells -= static_cast<int>(side);
            if (shells > 0) {
                position = hit.position + side * 2 * hit.error * hit.flat;
                continue;
            }
            shells = 1;
            if (!reflect(hit, position, direction, left) || mean(left) < kLeast) {
                return 0;
            }
        }
        return 0;
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

    // Nodes that share what light of the mean extinction scatters up to `distance` evenly, each at
    // the mean depth of its share.
    void scatter_along(glm::vec3 position, glm::vec3 direction, float distance, std::uint32_t view,
                       PerGroup& left) {
        constexpr int kDepths = 4;
        const WalkMedium& medium = space_.media.front();
        const float scattered = -std::expm1(-sigma_t_ * distance);
        float from = 0;
        for (int i = 1; i <= kDepths; ++i) {
            const float share = scattered * static_cast<float>(i) / kDepths;
            const float to =
                i < kDepths ? std::min(distance, -std::log1p(-share) / sigma_t_) : distance;
            FlightNode node{
                position + (from + mean_depth(to - from)) * direction, direction, {}, view};
            for (std::size_t g = 0; g < groups_; ++g) {
                node.weight[g] = left[g] * std::exp(-medium.sigma_t[g] * from) *
                                 -std::expm1(-medium.sigma_t[g] * (to - from));
            }
            nodes_.push_back(node);
            from = to;
        }
        for (std::size_t g = 0; g < groups_; ++g) {
            left[g] *= std::exp(-medium.sigma_t[g] * distance);
        }
    }

    // Of collisions within `length`: 1 / sigma_t - length / (e^x - 1), x its optical depth.
    float mean_depth(float length) const {
        constexpr float kThin = 1e-2f;
        const float x = sigma_t_ * length;
        return x < kThin ? length * (0.5f - x / 12) : 1 / sigma_t_ - length / std::expm1(x);
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

}  // namespace

FirstFlight trace_first_flight(const WalkSpace& space, const ViewSet& views,
                               const BodyPoint& point) {
    FirstFlight nodes;
    const int shells = std::max(1, count_shells(space, point.inner, -point.normal));
    FlightTracer tracer(space, nodes);
    float lost = 0;
    for (std::uint32_t v = 0; v < views.into.size(); ++v) {
        lost += views.share[v][0] * tracer.follow(point.inner, views.into[v], shells, v);
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
