#include "bake/slab/layer.h"

#include <Eigen/LU>
#include <cstddef>
#include <vector>

namespace opaline::bake {

// README.md, "Adding and doubling", derives both functions.

template <class Scalar>
Layer<Scalar> make_thin_layer(const LayerRates<Scalar>& rates, const Eigen::VectorXd& flux,
                              double depth) {
    using Matrix = typename Layer<Scalar>::Matrix;
    using Vector = typename Layer<Scalar>::Vector;
    // The term of degree n is about (depth extinction)^n / n! of the first.
    constexpr std::size_t kTerms = 6;
    const Vector flux_weights = flux.cast<Scalar>();
    const auto weights = flux_weights.asDiagonal();
    const Matrix rho = depth * rates.reflect, alpha = depth * rates.transmit;
    const Vector loss = depth * rates.extinction;
    const auto size = loss.size();
    // Of degree n: reflect[n], transmit[n], straight[n]; turned[n] = rho F reflect[n].
    std::vector<Matrix> reflect{Matrix::Zero(size, size)}, transmit = reflect, turned = reflect;
    std::vector<Vector> straight{Vector::Ones(size)};
    for (std::size_t n = 0; n < kTerms; ++n) {
        const double degree = static_cast<double>(n) + 1;
        // A layer on top: reflects by itself, dims and scatters what goes down and comes back, and
        // returns to the slab below what that reflects.
        const Matrix through = alpha * weights * reflect[n] - loss.asDiagonal() * reflect[n];
        Matrix next = through + through.transpose();
        for (std::size_t i = 1; i < n; ++i) {
            next += reflect[i] * weights * turned[n - i];
        }
        // What enters the slab below, having gone straight to it or not.
        Matrix down = -(transmit[n] * loss.asDiagonal()) + transmit[n] * weights * alpha +
                      straight[n].asDiagonal() * alpha;
        for (std::size_t i = 0; i < n; ++i) {
            down += straight[i].asDiagonal() * turned[n - i];
            if (i > 0) {
                down += transmit[i] * weights * turned[n - i];
            }
        }
        if (n == 0) {
            next += rho;
        }
        reflect.push_back(next / degree);
        transmit.push_back(down / degree);
        turned.push_back(rho * weights * reflect.back());
        straight.push_back(-loss.cwiseProduct(straight[n]) / degree);
    }
    Layer<Scalar> layer{reflect.back(), transmit.back(), loss};
    for (std::size_t n = kTerms; n-- > 1;) {  // small terms first
        layer.reflect += reflect[n];
        layer.transmit += transmit[n];
    }
    return layer;
}

template <class Scalar>
Layer<Scalar> double_layer(const Layer<Scalar>& layer, const Eigen::VectorXd& flux) {
    using Matrix = typename Layer<Scalar>::Matrix;
    const typename Layer<Scalar>::Vector flux_weights = flux.cast<Scalar>();
    const auto weights = flux_weights.asDiagonal();
    const typename Layer<Scalar>::Vector straight = layer.direct();
    const auto direct = straight.asDiagonal();
    const auto size = straight.size();
    // Between the layers: light that was scattered goes down, D, and all goes up, U.
    const Matrix turn = layer.reflect * weights * layer.reflect;
    const Matrix down = (Matrix::Identity(size, size) - turn * weights)
                            .partialPivLu()
                            .solve(layer.transmit + turn * direct);
    const Matrix bounced = layer.reflect * weights;
    const Matrix up = layer.reflect * direct + bounced * down;
    const Matrix carried = layer.transmit * weights;
    return {layer.reflect + direct * up + carried * up,
            direct * down + layer.transmit * direct + carried * down, 2.0 * layer.slant};
}

template Layer<double> make_thin_layer(const LayerRates<double>&, const Eigen::VectorXd&, double);
template Layer<std::complex<double>> make_thin_layer(const LayerRates<std::complex<double>>&,
                                                     const Eigen::VectorXd&, double);
template Layer<double> double_layer(const Layer<double>&, const Eigen::VectorXd&);
template Layer<std::complex<double>> double_layer(const Layer<std::complex<double>>&,
                                                  const Eigen::VectorXd&);

}  // namespace opaline::bake
