#include "bake/physics/slab/streams.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {

Streams make_streams(int quadrature, std::span<const double> others, double split) {
    assert(quadrature > 0 && split >= 0 && split < 1);
    const int parts = split > 0 ? 2 : 1, each = (quadrature + parts - 1) / parts;
    const GaussLegendre rule = make_gauss_legendre(each);
    Streams streams;
    streams.quadrature = parts * each;
    streams.resolved = 2 * each;
    streams.cosine.resize(streams.quadrature + static_cast<Eigen::Index>(others.size()));
    streams.weight.resize(streams.quadrature);
    for (int i = 0; i < streams.quadrature; ++i) {
        const bool low = split > 0 && i < each;
        const double from = low ? 0 : split, width = low ? split : 1 - split;
        const auto k = static_cast<std::size_t>(i % each);
        streams.cosine[i] = from + width * rule.node[k];
        streams.weight[i] = width * rule.weight[k];
    }
    for (std::size_t i = 0; i < others.size(); ++i) {
        assert(others[i] > 0 && others[i] <= 1);
        streams.cosine[streams.quadrature + static_cast<Eigen::Index>(i)] = others[i];
    }
    return streams;
}

Eigen::MatrixXd associated_legendre(const Eigen::VectorXd& cosine, int m, int degrees) {
    assert(m >= 0 && m < degrees);
    Eigen::MatrixXd value(degrees - m, cosine.size());
    for (Eigen::Index i = 0; i < cosine.size(); ++i) {
        const double x = cosine[i], sine = std::sqrt((1 - x) * (1 + x));
        double last = 0, now = 1;
        for (int k = 1; k <= m; ++k) {  // degree m: sqrt((2 m - 1)!! / (2 m)!!) sine^m
            now *= sine * std::sqrt((2 * k - 1) / (2.0 * k));
        }
        for (int l = m; l < degrees; ++l) {
            value(l - m, i) = now;
            const double next =
                ((2 * l + 1) * x * now - std::sqrt(double(l - m) * (l + m)) * last) /
                std::sqrt(double(l + 1 - m) * (l + 1 + m));
            last = now;
            now = next;
        }
    }
    return value;
}

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
    if (m >= degrees) return kernels;
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
