#include "bake/effects/multiple/walks/site_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace opaline::bake {
namespace {

std::vector<SurfacePoint> site_points(std::span<const SurfaceSample> samples) {
    std::vector<SurfacePoint> points;
    points.reserve(samples.size());
    for (const SurfaceSample& s : samples) {
        points.push_back({.position = s.position, .normal = s.normal});
    }
    return points;
}

// Fewer are too few for a function of six or seven coefficients.
constexpr std::size_t kFewestNeighbours = 8;

}  // namespace

SiteField::SiteField(std::span<const SurfaceSample> sites, float radius, std::vector<float> tints)
    : tint_(std::move(tints)), radius_(radius), grid_(site_points(sites), radius) {
    for (const SurfaceSample& s : sites) {
        position_.push_back(s.position);
        normal_.push_back(s.normal);
    }
}

std::vector<NearSite> SiteField::collect(glm::vec3 position, glm::vec3 normal, float tint,
                                         std::vector<std::uint32_t>& around) const {
    std::vector<NearSite> neighbours;
    const auto collect_within = [&](float radius) {
        neighbours.clear();
        for (const std::uint32_t s : around) {
            const glm::vec3 d = (position_[s] - position) / radius;
            const float inside = 1 - glm::dot(d, d), facing = glm::dot(normal, normal_[s]);
            if (inside > 0 && facing > 0) {
                neighbours.push_back({s, static_cast<double>(inside * inside * facing * facing), d,
                                      normal_[s], tint_.empty() ? 0 : tint_[s] - tint});
            }
        }
    };
    collect_within(radius_);
    if (neighbours.size() < kFewestNeighbours) {
        // Near the tip of a spike, or on a part smaller than the radius: the nearest ones.
        around.resize(position_.size());
        for (std::uint32_t s = 0; s < around.size(); ++s) {
            around[s] = s;
        }
        for (float radius = 1.5f * radius_, most = 100 * radius_;
             neighbours.size() < std::min(kFewestNeighbours, position_.size()) && radius < most;
             radius *= 1.5f) {
            collect_within(radius);
        }
    }
    return neighbours;
}

void SiteField::weigh(glm::vec3 position, glm::vec3 normal, std::vector<SiteWeight>& weights,
                      float tint) const {
    weights.clear();
    std::vector<std::uint32_t> around;
    grid_.collect_around(grid_.cell_of(position), around);
    const std::vector<NearSite> neighbours = collect(position, normal, tint, around);
    if (neighbours.empty()) {
        // Nothing faces the same way.
        const auto distance = [&](std::uint32_t s) { return glm::length(position_[s] - position); };
        const auto best = std::min_element(
            around.begin(), around.end(),
            [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
        if (best != around.end()) {
            weights.push_back({*best, 1});
        }
        return;
    }
    fit_near_sites(neighbours, normal, !tint_.empty(), weights);
}

}  // namespace opaline::bake
