#include "bake/effects/multiple/walks/site_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/base/frame.h"

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

std::vector<SiteField::Neighbour> SiteField::collect(glm::vec3 position, glm::vec3 normal,
                                                     std::vector<std::uint32_t>& around) const {
    std::vector<Neighbour> neighbours;
    const auto collect_within = [&](float radius) {
        neighbours.clear();
        for (const std::uint32_t s : around) {
            const glm::vec3 d = (position_[s] - position) / radius;
            const float inside = 1 - glm::dot(d, d), facing = glm::dot(normal, normal_[s]);
            if (inside > 0 && facing > 0) {
                neighbours.push_back(
                    {s, static_cast<double>(inside * inside * facing * facing), d});
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

// A site's place relative to a receiver: 1, two offsets in radii, two coordinates of the normal,
// the cosine between both normals less 1, which tells the crest of a ridge from its flanks, and the
// difference of tints where there are some.
template <int kCoefficients>
void SiteField::fit(std::span<const Neighbour> neighbours, glm::vec3 normal, float tint,
                    std::vector<SiteWeight>& weights) const {
    constexpr float kFacingScale = 2, kTintScale = 2;
    using Coordinates = Eigen::Matrix<double, kCoefficients, 1>;
    using Matrix = Eigen::Matrix<double, kCoefficients, kCoefficients>;
    const Frame frame = make_frame(normal);
    const auto place = [&](const Neighbour& n) {
        Coordinates at;
        at(0) = 1;
        at(1) = static_cast<double>(glm::dot(frame.u, n.offset));
        at(2) = static_cast<double>(glm::dot(frame.v, n.offset));
        at(3) = static_cast<double>(glm::dot(frame.u, normal_[n.site]));
        at(4) = static_cast<double>(glm::dot(frame.v, normal_[n.site]));
        at(5) = static_cast<double>(kFacingScale * (glm::dot(normal, normal_[n.site]) - 1));
        if constexpr (kCoefficients > 6) {
            at(6) = static_cast<double>(kTintScale * (tint_[n.site] - tint));
        }
        return at;
    };
    Matrix normal_matrix = Matrix::Zero();
    for (const Neighbour& n : neighbours) {
        const Coordinates at = place(n);
        normal_matrix += n.kernel * at * at.transpose();
    }
    // Slopes that no site tells about are 0.
    constexpr double kRidge = 1e-2;
    const double all = normal_matrix(0, 0);
    for (int i = 1; i < kCoefficients; ++i) {
        normal_matrix(i, i) += kRidge * all;
    }
    const Coordinates solved = normal_matrix.ldlt().solve(Coordinates::Unit(0));
    for (const Neighbour& n : neighbours) {
        weights.push_back({n.site, static_cast<float>(n.kernel * solved.dot(place(n)))});
    }
}

void SiteField::weigh(glm::vec3 position, glm::vec3 normal, std::vector<SiteWeight>& weights,
                      float tint) const {
    weights.clear();
    std::vector<std::uint32_t> around;
    grid_.collect_around(grid_.cell_of(position), around);
    const std::vector<Neighbour> neighbours = collect(position, normal, around);
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
    tint_.empty() ? fit<6>(neighbours, normal, tint, weights)
                  : fit<7>(neighbours, normal, tint, weights);
}

}  // namespace opaline::bake
