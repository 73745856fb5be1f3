#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bake/physics/slab/layer.h"
#include "bake/physics/slab/streams.h"

namespace opaline::bake {

/// The smooth boundaries of a slab whose index is `eta` times that of both sides, for the streams
/// inside it. Of each stream outside of the cone of total reflection the light outside is that
/// which refraction makes of it.
struct SlabBoundary {
    double eta = 1;
    Eigen::VectorXd reflect, pass;  ///< Fresnel's reflectance, and 1 less that, by stream
    Eigen::VectorXd entering;       ///< share of even light outside, by node of the rule
    double never_entering = 0;      ///< share of it that is reflected totally, for eta < 1
};

/// The cosine inside below which light is reflected totally; 0 for eta <= 1.
double critical_cosine(double eta);

/// The cosines inside of beams outside; a tiny one for beams that do not enter.
std::vector<double> refracted_cosines(std::span<const double> outside, double eta);

/// `outside`: cosines of the streams after the rule's nodes, outside. eta in [1/3, 3].
SlabBoundary make_slab_boundary(const Streams& streams, std::span<const double> outside,
                                double eta);

/// Shares of the flux of a beam, by stream: what is reflected by the boundary or by the slab, and
/// what is transmitted.
template <class Scalar>
struct StreamFluxes {
    typename Layer<Scalar>::Vector reflected, transmitted;
};

/// A slab between such boundaries. By reciprocity the flux that leaves under a beam is the radiance
/// under even light. The depth of the layer must be above 0: totally reflected light has no other
/// way out.
template <class Scalar>
StreamFluxes<Scalar> sum_bounded_fluxes(const Layer<Scalar>& layer, const Eigen::VectorXd& flux,
                                        const SlabBoundary& boundary);

extern template StreamFluxes<double> sum_bounded_fluxes(const Layer<double>&,
                                                        const Eigen::VectorXd&,
                                                        const SlabBoundary&);
extern template StreamFluxes<std::complex<double>> sum_bounded_fluxes(
    const Layer<std::complex<double>>&, const Eigen::VectorXd&, const SlabBoundary&);

}  // namespace opaline::bake
