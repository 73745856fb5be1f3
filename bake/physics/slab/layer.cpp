#include "bake/physics/slab/layer.h"

#include <Eigen/LU>
#include <cstddef>
#include <vector>

namespace opaline::bake {
namespace {

/// Products of kernels: one light after the other, integrated over the cosine in between.
template <class Scalar>
class KernelProduct {
  public:
    using Matrix = typename Layer<Scalar>::Matrix;

    explicit KernelProduct(const Eigen::VectorXd& flux) : flux_(flux.cast<Scalar>()) {}

    Matrix operator()(const Matrix& after, const Matrix& before) const {
        return after.leftCols(flux_.size()) * flux_.asDiagonal() * before.topRows(flux_.size());
    }

  private:
    typename Layer<Scalar>::Vector flux_;
};

}  // namespace

// README.md, "Adding and doubling", derives both functions.

template <class Scalar>
Layer<Scalar> make_thin_layer(const LayerRates<Scalar>& rates, const Eigen::VectorXd& flux,
                              double depth) {
    using Matrix = typename Layer<Scalar>::Matrix;
    using Vector = typename Layer<Scalar>::Vector;
    // The term of degree n is about (depth extinction)^n / n! of the first.
    constexpr std::size_t kTerms = 6;
    const KernelProduct<Scalar> product(flux);
    const Matrix rho = depth * rates.reflect, alpha = depth * rates.transmit;
    const Vector loss = depth * rates.extinction, entering = loss.head(rho.cols());
    // Of degree n: reflect[n], transmit[n], straight[n]; turned[n] = rho F reflect[n].
    std::vector<Matrix> reflect{Matrix::Zero(rho.rows(), rho.cols())}, transmit = reflect,
                                                                       turned = reflect;
    std::vector<Vector> straight{Vector::Ones(loss.size())};
    for (std::size_t n = 0; n < kTerms; ++n) {
        const double degree = static_cast<double>(n) + 1;
        // A layer on top: reflects by itself, dims and scatters what goes down and comes back, and
        // returns to the slab below what that reflects.
        Matrix next = product(alpha, reflect[n]) - loss.asDiagonal() * reflect[n] +
                      product(reflect[n], alpha) - reflect[n] * entering.asDiagonal();
        for (std::size_t i = 1; i < n; ++i) {
            next += product(reflect[i], turned[n - i]);
        }
        // What enters the slab below, having gone straight to it or not.
        Matrix down = product(transmit[n], alpha) - transmit[n] * entering.asDiagonal() +
                      straight[n].asDiagonal() * alpha;
        for (std::size_t i = 0; i < n; ++i) {
            down += straight[i].asDiagonal() * turned[n - i];
            if (i > 0) {
                down += product(transmit[i], turned[n - i]);
            }
        }
        if (n == 0) {
            next += rho;
        }
        reflect.push_back(next / degree);
        transmit.push_back(down / degree);
        turned.push_back(product(rho, reflect.back()));
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
    const KernelProduct<Scalar> product(flux);
    const auto nodes = flux.size();
    const typename Layer<Scalar>::Vector straight = layer.straight();
    const auto leaving = straight.asDiagonal();
    const auto entering = straight.head(layer.reflect.cols()).asDiagonal();
    // Between the layers: light that was scattered goes down, and all goes up. Down first between
    // the nodes of the rule, where it is what it is made of.
    const Matrix turn = product(layer.reflect, layer.reflect);
    Matrix down = layer.transmit + turn * entering;
    const Matrix between = turn.topLeftCorner(nodes, nodes) * flux.cast<Scalar>().asDiagonal();
    const Matrix at_nodes =
        (Matrix::Identity(nodes, nodes) - between).partialPivLu().solve(down.topRows(nodes));
    down += product(turn, at_nodes);
    const Matrix up = layer.reflect * entering + product(layer.reflect, down);
    return {layer.reflect + leaving * up + product(layer.transmit, up),
            leaving * down + layer.transmit * entering + product(layer.transmit, down),
            2.0 * layer.slant};
}

template Layer<double> make_thin_layer(const LayerRates<double>&, const Eigen::VectorXd&, double);
template Layer<std::complex<double>> make_thin_layer(const LayerRates<std::complex<double>>&,
                                                     const Eigen::VectorXd&, double);
template Layer<double> double_layer(const Layer<double>&, const Eigen::VectorXd&);
template Layer<std::complex<double>> double_layer(const Layer<std::complex<double>>&,
                                                  const Eigen::VectorXd&);

}  // namespace opaline::bake
