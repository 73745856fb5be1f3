#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bake/physics/slab/slab_medium.h"

namespace opaline::bake {

/// Directions at which the light in a slab is known: the nodes of a Gauss-Legendre rule over the
/// cosines of a hemisphere, then any others.
struct Streams {
    int quadrature = 0;      ///< number of nodes of the rule; they stand first
    int resolved = 0;        ///< degrees of Legendre polynomials that the rule integrates exactly
    Eigen::VectorXd cosine;  ///< to the normal, in (0, 1]
    Eigen::VectorXd weight;  ///< of the rule's nodes, of sum 1

    /// 2 cosine weight of the rule's nodes: share of the flux of even light, of sum 1.
    Eigen::VectorXd flux() const { return 2 * cosine.head(quadrature).cwiseProduct(weight); }
};

/// `quadrature` at least 1; `others` in (0, 1]. With a `split` above 0 the rule is one below that
/// cosine and one above, of as many nodes: where light is reflected totally on one side of it.
Streams make_streams(int quadrature, std::span<const double> others, double split = 0);

/// Associated Legendre functions of the order m over degree and stream, sqrt((l - m)! / (l + m)!)
/// P_l^m(cosine), without the sign (-1)^m: row l - m holds degree l, up to degree `degrees` - 1.
/// 0 <= m < degrees.
Eigen::MatrixXd associated_legendre(const Eigen::VectorXd& cosine, int m, int degrees);

/// A phase function in one azimuth mode, between streams (rows and columns as in Layer): p++ and
/// p+-, (for m = 0) the mean over the azimuth, of mean 2 over the cosines, without the peak that is
/// not resolved.
struct PhaseKernels {
    Eigen::MatrixXd forward, backward;
    double peak = 0;  ///< share of the scattering that goes straight on [Wiscombe1977]
};

/// Of mode m, `entering` columns, with as many moments as the streams resolve: 2 a node of the
/// rule.
PhaseKernels make_phase_kernels(const SlabMedium& medium, const Streams& streams, int m,
                                Eigen::Index entering);

}  // namespace opaline::bake
