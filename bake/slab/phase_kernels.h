#pragma once

#include <Eigen/Core>

#include "bake/slab/slab_medium.h"
#include "bake/slab/streams.h"

namespace opaline::bake {

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
