#include "bake/slab/streams.h"

#include <cassert>
#include <cmath>
#include <cstddef>

#include "bake/scattering/gauss_legendre.h"

namespace opaline::bake {

Streams make_streams(int quadrature, std::span<const double> others) {
    assert(quadrature > 0);
    const GaussLegendre rule = make_gauss_legendre(quadrature);
    const auto count = quadrature + static_cast<Eigen::Index>(others.size());
    Streams streams{quadrature, Eigen::VectorXd(count), Eigen::VectorXd(quadrature)};
    for (Eigen::Index i = 0; i < count; ++i) {
        if (i < quadrature) {
            const auto k = static_cast<std::size_t>(i);
            streams.cosine[i] = rule.node[k];
            streams.weight[i] = rule.weight[k];
        } else {
            const double given = others[static_cast<std::size_t>(i - quadrature)];
            assert(given > 0 && given <= 1);
            streams.cosine[i] = given;
        }
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

}  // namespace opaline::bake
