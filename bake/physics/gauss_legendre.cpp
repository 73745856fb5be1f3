#include "bake/physics/gauss_legendre.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace opaline::bake {

GaussLegendre make_gauss_legendre(int n) {
    const auto count = static_cast<std::size_t>(n);
    GaussLegendre rule{std::vector<double>(count), std::vector<double>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        // Newton's method on the Legendre polynomial of degree n from the usual cosine guess.
        double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (n + 0.5));
        double slope = 1;
        for (int step = 0; step < 100; ++step) {
            double p = x, before = 1;
            for (int k = 2; k <= n; ++k) {
                const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                before = p;
                p = next;
            }
            slope = n * (x * p - before) / (x * x - 1);
            const double delta = p / slope;
            x -= delta;
            if (std::abs(delta) < 1e-16) break;
        }
        rule.node[count - 1 - i] = 0.5 * (1 + x);
        rule.weight[count - 1 - i] = 1 / ((1 - x * x) * slope * slope);
    }
    return rule;
}

}  // namespace opaline::bake
