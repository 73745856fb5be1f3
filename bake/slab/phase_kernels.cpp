#include "bake/slab/phase_kernels.h"

#include <algorithm>
#include <cstddef>

namespace opaline::bake {

PhaseKernels make_phase_kernels(const SlabMedium& medium, const Streams& streams, int m,
                                Eigen::Index entering) {
    const int resolved = streams.resolved;
    const auto moments = static_cast<int>(medium.moment.size());
    PhaseKernels kernels;
    kernels.peak = moments > resolved ? medium.moment[static_cast<std::size_t>(resolved)] : 0;
    // A peak of more than the whole, or a negative one, is no peak: the moments are cut.
    if (kernels.peak < 0 || kernels.peak >= 1) {
        kernels.peak = 0;
    }
    const auto count = streams.cosine.size();
    kernels.forward = kernels.backward = Eigen::MatrixXd::Zero(count, entering);
    const int degrees = kernels.peak > 0 ? resolved : std::min(moments, resolved);
    if (m >= degrees) {
        return kernels;
    }
    const Eigen::MatrixXd legendre = associated_legendre(streams.cosine, m, degrees);
    Eigen::VectorXd even = Eigen::VectorXd::Zero(degrees - m), odd = even;
    for (int l = m; l < degrees; ++l) {
        const double scaled =
            (2 * l + 1) * (medium.moment[static_cast<std::size_t>(l)] - kernels.peak);
        ((l + m) % 2 == 0 ? even : odd)[l - m] = scaled;
    }
    const Eigen::MatrixXd columns = legendre.leftCols(entering);
    const Eigen::MatrixXd same = legendre.transpose() * even.asDiagonal() * columns;
    const Eigen::MatrixXd turned = legendre.transpose() * odd.asDiagonal() * columns;
    kernels.forward = same + turned;
    kernels.backward = same - turned;
    return kernels;
}

}  // namespace opaline::bake
