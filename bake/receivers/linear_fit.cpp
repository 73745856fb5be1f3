#include "bake/receivers/linear_fit.h"

#include <Eigen/Dense>

#include "bake/base/frame.h"

namespace opaline::bake {
namespace {

template <int kCoefficients>
void fit(std::span<const NearSite> sites, glm::vec3 normal, std::vector<SiteWeight>& weights) {
    constexpr float kFacingScale = 2, kTintScale = 2;
    using Coordinates = Eigen::Matrix<double, kCoefficients, 1>;
    using Matrix = Eigen::Matrix<double, kCoefficients, kCoefficients>;
    const Frame frame = make_frame(normal);
    const auto place = [&](const NearSite& n) {
        Coordinates at;
        at(0) = 1;
        at(1) = static_cast<double>(glm::dot(frame.u, n.offset));
        at(2) = static_cast<double>(glm::dot(frame.v, n.offset));
        at(3) = static_cast<double>(glm::dot(frame.u, n.normal));
        at(4) = static_cast<double>(glm::dot(frame.v, n.normal));
        at(5) = static_cast<double>(kFacingScale * (glm::dot(normal, n.normal) - 1));
        if constexpr (kCoefficients > 6) {
            at(6) = static_cast<double>(kTintScale * n.tint);
        }
        return at;
    };
    Matrix normal_matrix = Matrix::Zero();
    for (const NearSite& n : sites) {
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
    for (const NearSite& n : sites) {
        weights.push_back({n.site, static_cast<float>(n.kernel * solved.dot(place(n)))});
    }
}

}  // namespace

void fit_near_sites(std::span<const NearSite> sites, glm::vec3 normal, bool has_tints,
                    std::vector<SiteWeight>& weights) {
    has_tints ? fit<7>(sites, normal, weights) : fit<6>(sites, normal, weights);
}

}  // namespace opaline::bake
