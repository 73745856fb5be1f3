#include "bake/effects/multiple/walks/site_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "bake/base/frame.h"

namespace opaline::bake {
namespace {

std::vector<SurfacePoint> points_of(std::span<const SurfaceSample> samples) {
    std::vector<SurfacePoint> points;
    points.reserve(samples.size());
    for (const SurfaceSample& s : samples) {
        points.push_back({.position = s.position, .normal = s.normal});
    }
    return points;
}

// A site's place relative to a receiver: 1, two offsets in radii, two coordinates of the normal.
using Coordinates = Eigen::Matrix<double, 5, 1>;

struct Neighbour {
    std::uint32_t site;
    double kernel;
    Coordinates place;
};

// Fewer are too few for a function of five coefficients.
constexpr std::size_t kFewest = 8;

}  // namespace

SiteField::SiteField(std::span<const SurfaceSample> sites, float radius)
    : radius_(radius), grid_(points_of(sites), radius) {
    for (const SurfaceSample& s : sites) {
        position_.push_back(s.position);
        normal_.push_back(s.normal);
    }
}

void SiteField::weigh(glm::vec3 position, glm::vec3 normal,
                      std::vector<SiteWeight>& weights) const {
    weights.clear();
    std::vector<std::uint32_t> around;
    grid_.collect_around(grid_.cell_of(position), around);
    const Frame frame = make_frame(normal);
    std::vector<Neighbour> neighbours;
    const auto collect = [&](float radius) {
        neighbours.clear();
        for (const std::uint32_t s : around) {
            const glm::vec3 d = (position_[s] - position) / radius;
            const float inside = 1 - glm::dot(d, d), facing = glm::dot(normal, normal_[s]);
            if (inside > 0 && facing > 0) {
                Neighbour n{s, static_cast<double>(inside * inside * facing * facing), {}};
                n.place << 1, static_cast<double>(glm::dot(frame.u, d)),
                    static_cast<double>(glm::dot(frame.v, d)),
                    static_cast<double>(glm::dot(frame.u, normal_[s])),
                    static_cast<double>(glm::dot(frame.v, normal_[s]));
                neighbours.push_back(n);
            }
        }
    };
    collect(radius_);
    if (neighbours.size() < kFewest) {
        // Near the tip of a spike, or on a part smaller than the radius: the nearest ones.
        around.resize(position_.size());
        for (std::uint32_t s = 0; s < around.size(); ++s) {
            around[s] = s;
        }
        for (float radius = 1.5f * radius_, most = 100 * radius_;
             neighbours.size() < std::min(kFewest, position_.size()) && radius < most;
             radius *= 1.5f) {
            collect(radius);
        }
    }
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
    Eigen::Matrix<double, 5, 5> normal_matrix = Eigen::Matrix<double, 5, 5>::Zero();
    for (const Neighbour& n : neighbours) {
        normal_matrix += n.kernel * n.place * n.place.transpose();
    }
    // Slopes that no site tells about are 0.
    constexpr double kRidge = 1e-2;
    const double all = normal_matrix(0, 0);
    for (int i = 1; i < 5; ++i) {
        normal_matrix(i, i) += kRidge * all;
    }
    const Coordinates fit = normal_matrix.ldlt().solve(Coordinates::Unit(0));
    for (const Neighbour& n : neighbours) {
        weights.push_back({n.site, static_cast<float>(n.kernel * fit.dot(n.place))});
    }
}

}  // namespace opaline::bake
