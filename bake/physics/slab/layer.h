#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>

#include "bake/physics/slab/streams.h"

namespace opaline::bake {

/// What a homogeneous layer does with one azimuth mode of light. The kernels are symmetric, by
/// reciprocity: light of radiance I(mu') on the layer leaves as 2 int K(mu, mu') mu' I(mu') dmu',
/// so K = 1 is a white diffuse surface. Rows: the cosines at which light leaves, first those of the
/// rule that integrals are taken by. Columns: those at which it enters, the first of the rows.
/// Complex where the albedo is (`solve_slab`).
template <class Scalar>
struct Layer {
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    Matrix reflect, transmit;  ///< kernels; `transmit` without what goes straight
    Vector slant;              ///< optical depth along each row's direction

    /// Share that goes straight, by row. Not carried from layer to layer: squared k times, an error
    /// of 1e-16 would become 2^k of it.
    Vector straight() const { return (-slant).array().exp().matrix(); }
};

/// A layer per unit of optical depth, for one mode: rows and columns as in Layer.
template <class Scalar>
struct LayerRates {
    typename Layer<Scalar>::Matrix reflect, transmit;  ///< kernels of light scattered once
    typename Layer<Scalar>::Vector extinction;         ///< over the cosine
};

/// A layer so thin that depth times every entry of `rates.extinction` is at most
/// kThinLayerDepth: the first terms of its power series in the depth, to 1e-14. `flux`: 2 mu w of
/// the rule, as many entries as it has nodes.
template <class Scalar>
Layer<Scalar> make_thin_layer(const LayerRates<Scalar>& rates, const Eigen::VectorXd& flux,
                              double depth);
inline constexpr double kThinLayerDepth = 1.0 / 64;

/// Two such layers, one on the other [vandeHulst1980].
template <class Scalar>
Layer<Scalar> double_layer(const Layer<Scalar>& layer, const Eigen::VectorXd& flux);

extern template Layer<double> make_thin_layer(const LayerRates<double>&, const Eigen::VectorXd&,
                                              double);
extern template Layer<std::complex<double>> make_thin_layer(const LayerRates<std::complex<double>>&,
                                                            const Eigen::VectorXd&, double);
extern template Layer<double> double_layer(const Layer<double>&, const Eigen::VectorXd&);
extern template Layer<std::complex<double>> double_layer(const Layer<std::complex<double>>&,
                                                         const Eigen::VectorXd&);

/// The layers of a doubling chain from the depth of `optical_depth` / 2^`halvings` up, each handed
/// to `take(halvings left, layer)`.
template <class Scalar, class Take>
void double_up(const PhaseKernels& kernels, const Streams& streams, Scalar albedo,
               double optical_depth, unsigned halvings, const Take& take) {
    const Eigen::VectorXd inverse = streams.cosine.cwiseInverse();
    const Scalar extinction = 1.0 - albedo * kernels.peak;
    LayerRates<Scalar> rates;
    rates.extinction = extinction * inverse.cast<Scalar>();
    const Scalar quarter = albedo / 4.0;
    const auto leaving = inverse.asDiagonal();
    const auto entering = inverse.head(kernels.forward.cols()).asDiagonal();
    rates.reflect = quarter * (leaving * kernels.backward * entering).eval().cast<Scalar>();
    rates.transmit = quarter * (leaving * kernels.forward * entering).eval().cast<Scalar>();
    const double steepest = std::abs(extinction) * inverse.maxCoeff();
    unsigned doublings = halvings;
    while (std::ldexp(optical_depth * steepest, -static_cast<int>(doublings)) > kThinLayerDepth) {
        ++doublings;
    }
    const Eigen::VectorXd flux = streams.flux();
    Layer<Scalar> layer =
        make_thin_layer(rates, flux, std::ldexp(optical_depth, -static_cast<int>(doublings)));
    for (unsigned left = doublings;; --left) {
        if (left <= halvings) {
            take(left, std::as_const(layer));
        }
        if (left == 0) return;
        layer = double_layer(layer, flux);
    }
}

}  // namespace opaline::bake
