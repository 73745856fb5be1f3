#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "bake/physics/gauss_legendre.h"

namespace opaline::tests {

/// What a plane slab of index 1 with a Henyey-Greenstein phase function reflects and transmits
/// after one scattering at least, by doubling (van de Hulst 1980): averages over the azimuth, at
/// the nodes of a Gauss-Legendre rule within each of some bins of the cosine, and along the normal.
class DoubledSlab {
  public:
    static constexpr int kPerBin = 8;

    DoubledSlab(double thickness, double albedo, double g, int bins) {
        const bake::GaussLegendre rule = bake::make_gauss_legendre(kPerBin);
        for (int bin = 0; bin < bins; ++bin) {
            for (int i = 0; i < kPerBin; ++i) {
                const auto k = static_cast<std::size_t>(i);
                cosine_.push_back((bin + rule.node[k]) / bins);
                weight_.push_back(rule.weight[k] / bins);
            }
        }
        cosine_.push_back(1);  // light and views along the normal
        weight_.push_back(0);
        double depth = std::ldexp(thickness, -kDoublings);
        start(depth, albedo, g);
        for (int i = 0; i < kDoublings; ++i, depth *= 2) {
            twice(depth);
        }
    }

    int nodes() const { return static_cast<int>(cosine_.size()) - 1; }
    double cosine(int i) const { return cosine_[static_cast<std::size_t>(i)]; }
    /// Of the integral over cosines.
    double weight(int i) const { return weight_[static_cast<std::size_t>(i)]; }
    /// Radiance toward node i of light along the normal of flux 1 per area.
    double reflected_beam(int i) const { return reflect_(i, nodes()); }
    double transmitted_beam(int i) const { return transmit_(i, nodes()); }
    /// Radiance toward node i (nodes(): the normal) under uniform light of 1 from the same side, or
    /// from the other.
    double reflected_sky(int i) const { return under_sky(reflect_, i); }
    double transmitted_sky(int i) const { return under_sky(transmit_, i); }

  private:
    static constexpr int kDoublings = 24;

    double flux(int i) const { return 2 * std::numbers::pi * weight(i) * cosine(i); }
    double under_sky(const Eigen::MatrixXd& kernel, int i) const {
        double sum = 0;
        for (int j = 0; j < nodes(); ++j) {
            sum += kernel(i, j) * flux(j);
        }
        return sum;
    }

    // Single scattering in a layer so thin that nothing scatters twice.
    void start(double depth, double albedo, double g) {
        const auto n = static_cast<Eigen::Index>(cosine_.size());
        reflect_ = transmit_ = Eigen::MatrixXd::Zero(n, n);
        // The phase function without the azimuth, by Legendre's polynomials.
        constexpr unsigned kDegrees = 64;
        Eigen::MatrixXd legendre(kDegrees, n);
        for (int i = 0; i < n; ++i) {
            for (unsigned l = 0; l < kDegrees; ++l) {
                legendre(l, i) = std::legendre(l, cosine(i));
            }
        }
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                double even = 0, odd = 0, power = 1;
                for (unsigned l = 0; l < kDegrees; ++l, power *= g) {
                    const double term = (2 * l + 1) * power * legendre(l, i) * legendre(l, j);
                    (l % 2 == 0 ? even : odd) += term;
                }
                const double scale =
                    albedo * depth / (4 * std::numbers::pi * cosine(i) * cosine(j));
                transmit_(i, j) = scale * (even + odd);
                reflect_(i, j) = scale * (even - odd);
            }
        }
    }

    // Two layers: D light down between them, U up, of a beam of flux 1 from above.
    void twice(double depth) {
        const auto n = static_cast<Eigen::Index>(cosine_.size());
        Eigen::VectorXd through(n), carried(n);
        for (int i = 0; i < n; ++i) {
            through(i) = std::exp(-depth / cosine(i));
            carried(i) = flux(i);
        }
        const Eigen::MatrixXd direct = through.asDiagonal(), r = reflect_ * carried.asDiagonal(),
                              t = transmit_ * carried.asDiagonal();
        const Eigen::MatrixXd down =
            (Eigen::MatrixXd::Identity(n, n) - r * r).lu().solve(transmit_ + r * reflect_ * direct);
        const Eigen::MatrixXd up = reflect_ * direct + r * down;
        reflect_ += direct * up + t * up;
        transmit_ = direct * down + t * down + transmit_ * direct;
    }

    std::vector<double> cosine_, weight_;
    Eigen::MatrixXd reflect_, transmit_;
};

}  // namespace opaline::tests
