#include "bake/effects/multiple/walks/view_set.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/gauss_legendre.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kRings = 4, kAzimuths = 8, kViews = kRings * kAzimuths;

using Functions = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kAllDegrees, kViews + 1>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kAllDegrees, kAllDegrees>;

// Light of density F_t(c) c that enters: Gauss's rule over c^2 with weight F_t(c), eight azimuths
// each, turned by a golden part of their distance from ring to ring.
void add_entering(double eta, glm::vec3 normal, ViewSet& views) {
    static const GaussLegendre rule = make_gauss_legendre(kRings);
    const Frame frame = make_frame(normal);
    const double least = std::max(0.0, 1 - eta * eta);  // of c^2: below, all is reflected
    double sum = 0;
    for (std::uint32_t i = 0; i < kViews; ++i) {
        const std::uint32_t ring = i / kAzimuths;
        const double cosine = std::sqrt(least + (1 - least) * rule.node[ring]);
        const double azimuth =
            2 * std::numbers::pi * (i % kAzimuths + ring * std::numbers::phi) / kAzimuths;
        const double inside = refracted_cosine(cosine, eta);
        const double sine = std::sqrt(std::max(0.0, 1 - inside * inside));
        views.into.push_back(frame.to_world(
            glm::vec3(glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), -inside))));
        const double passed = rule.weight[ring] * fresnel_transmittance(cosine, eta);
        views.share.push_back({static_cast<float>(passed)});
        sum += passed;
    }
    for (auto& share : views.share) {
        share[0] /= static_cast<float>(sum);
    }
}

// The functions that rows by view stand for, one a row, at each view.
Functions eval_functions(const ViewFit& fit, glm::vec3 normal, const ViewSet& views,
                         std::uint32_t count) {
    const ViewMatrix matrix = to_harmonics(fit, normal);
    Functions functions(count, views.into.size());
    for (std::size_t v = 0; v < views.into.size(); ++v) {
        const glm::vec3 seen = -views.into[v];
        std::array<float, 1 + kAllDegrees> harmonic{};
        formats::eval_spherical_harmonics({seen.x, seen.y, seen.z}, harmonic);
        for (std::uint32_t r = 0; r < count; ++r) {
            double value = 0;
            for (std::size_t k = 0; k < harmonic.size(); ++k) {
                value += static_cast<double>(matrix[k][r]) * static_cast<double>(harmonic[k]);
            }
            functions(r, static_cast<Eigen::Index>(v)) = value;
        }
    }
    return functions;
}

}  // namespace

ViewSet make_view_set(const ViewFit& fit, double eta, glm::vec3 normal, std::uint32_t rows) {
    // At .5 the error along the normal falls to a third of that at 0, over all views it grows by a
    // twentieth (README.md, "Views").
    constexpr double kNormal = 0.5;
    constexpr double kRidge = 1e-3;  // refracted views hardly separate some functions
    ViewSet views;
    add_entering(eta, normal, views);
    if (rows == 1) return views;
    views.into.push_back(-normal);
    views.share.push_back({});
    const Functions functions = eval_functions(fit, normal, views, rows - 1);
    const auto count = static_cast<Eigen::Index>(views.into.size());
    Eigen::VectorXd weight(count);
    for (Eigen::Index v = 0; v < count; ++v) {
        weight(v) =
            (1 - kNormal) * static_cast<double>(views.share[static_cast<std::size_t>(v)][0]);
    }
    weight(count - 1) = kNormal;
    Square gram = functions * weight.asDiagonal() * functions.transpose();
    gram.diagonal() *= 1 + kRidge;
    const Functions dual = gram.ldlt().solve(functions) * weight.asDiagonal();
    // What is fitted is T - T_0.
    const Eigen::VectorXd level = dual.rowwise().sum();
    for (Eigen::Index v = 0; v < count; ++v) {
        auto& share = views.share[static_cast<std::size_t>(v)];
        for (Eigen::Index r = 0; r < dual.rows(); ++r) {
            share[static_cast<std::size_t>(r) + 1] =
                static_cast<float>(dual(r, v) - level(r) * static_cast<double>(share[0]));
        }
    }
    return views;
}

}  // namespace opaline::bake
