#include "bake/physics/slab/boundary.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>

#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

/// 1 - e^-x, without cancellation.
double lost(double x) {
    return -std::expm1(-x);
}
std::complex<double> lost(std::complex<double> x) {
    constexpr double kSeriesBelow = 1e-2;
    if (std::abs(x) >= kSeriesBelow) return 1.0 - std::exp(-x);
    std::complex<double> sum = 0, power = -1;  // -(-x)^n / n!
    for (int n = 1; n < 8; ++n) {
        power *= -x / static_cast<double>(n);
        sum += power;
    }
    return sum;
}

}  // namespace

double critical_cosine(double eta) {
    return eta > 1 ? std::sqrt((eta - 1) * (eta + 1)) / eta : 0;
}

std::vector<double> refracted_cosines(std::span<const double> outside, double eta) {
    constexpr double kNone = 1e-6;
    std::vector<double> inside;
    inside.reserve(outside.size());
    for (const double cosine : outside) {
        inside.push_back(std::max(kNone, refracted_cosine(cosine, eta)));
    }
    return inside;
}

SlabBoundary make_slab_boundary(const Streams& streams, std::span<const double> outside,
                                double eta) {
    const auto count = streams.cosine.size();
    SlabBoundary boundary{eta, Eigen::VectorXd(count), Eigen::VectorXd(count),
                          eta * eta * streams.flux(), std::max(0.0, (1 - eta) * (1 + eta))};
    for (Eigen::Index i = 0; i < count; ++i) {
        const bool node = i < streams.quadrature;
        const double cosine =
            node ? streams.cosine[i] : outside[static_cast<std::size_t>(i - streams.quadrature)];
        const double index = node ? 1 / eta : eta;
        boundary.reflect[i] = fresnel_reflectance(cosine, index);
        boundary.pass[i] = fresnel_transmittance(cosine, index);
        if (node && cosine < critical_cosine(eta)) {
            boundary.reflect[i] = 1;
            boundary.pass[i] = boundary.entering[i] = 0;
        }
    }
    return boundary;
}

template <class Scalar>
StreamFluxes<Scalar> sum_bounded_fluxes(const Layer<Scalar>& layer, const Eigen::VectorXd& flux,
                                        const SlabBoundary& boundary) {
    using Matrix = typename Layer<Scalar>::Matrix;
    using Vector = typename Layer<Scalar>::Vector;
    // README.md, "Refracting boundaries". Inside, d goes down from the upper boundary and u' up
    // from the lower one; a = d + u' and b = d - u' are apart from each other.
    const auto nodes = flux.size();
    const auto rows = layer.slant.size();
    const Vector straight = layer.straight();
    Vector reflect(rows), pass(rows);
    reflect = boundary.reflect.cast<Scalar>();
    pass = boundary.pass.cast<Scalar>();
    const Matrix sum =
        (layer.transmit + layer.reflect).leftCols(nodes) * flux.cast<Scalar>().asDiagonal();
    const Matrix difference =
        (layer.reflect - layer.transmit).leftCols(nodes) * flux.cast<Scalar>().asDiagonal();
    Vector left_of_a(rows), left_of_b(rows);  // 1 - rho E, 1 + rho E
    for (Eigen::Index i = 0; i < rows; ++i) {
        left_of_a[i] = pass[i] + reflect[i] * lost(layer.slant[i]);
        left_of_b[i] = 1.0 + reflect[i] * straight[i];
    }
    const auto at_nodes = [&](const Matrix& scattered, const Vector& left) -> Vector {
        Matrix system = -(reflect.head(nodes).asDiagonal() * scattered.topRows(nodes));
        system.diagonal() += left.head(nodes);
        return system.partialPivLu().solve(pass.head(nodes));
    };
    const Vector scattered_a = sum * at_nodes(sum, left_of_a);
    const Vector scattered_b = difference * at_nodes(difference, left_of_b);
    StreamFluxes<Scalar> fluxes{Vector(rows), Vector(rows)};
    for (Eigen::Index i = 0; i < rows; ++i) {
        const Scalar a = (pass[i] + reflect[i] * scattered_a[i]) / left_of_a[i];
        const Scalar b = (pass[i] + reflect[i] * scattered_b[i]) / left_of_b[i];
        // What arrives at both boundaries from inside: u + d' and u - d'.
        const Scalar both = scattered_a[i] + straight[i] * a;
        const Scalar less = scattered_b[i] - straight[i] * b;
        fluxes.reflected[i] = reflect[i] + pass[i] * (both + less) / 2.0;
        fluxes.transmitted[i] = pass[i] * (both - less) / 2.0;
    }
    return fluxes;
}

template StreamFluxes<double> sum_bounded_fluxes(const Layer<double>&, const Eigen::VectorXd&,
                                                 const SlabBoundary&);
template StreamFluxes<std::complex<double>> sum_bounded_fluxes(const Layer<std::complex<double>>&,
                                                               const Eigen::VectorXd&,
                                                               const SlabBoundary&);

}  // namespace opaline::bake
