#pragma once

#include <cmath>
#include <cstddef>
#include <utility>

#include "bake/slab/layer.h"
#include "bake/slab/phase_kernels.h"
#include "bake/slab/streams.h"

namespace opaline::bake {

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
        if (left == 0) {
            return;
        }
        layer = double_layer(layer, flux);
    }
}

}  // namespace opaline::bake
