#include "bake/scattering/phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::bake {

double henyey_greenstein(double cosine, double g) {
    // (1 - g)^2 + 2 g (1 - cos) is 1 + g^2 - 2 g cos without its cancellation.
    const double base = (1 - g) * (1 - g) + 2 * g * (1 - cosine);
    return (1 - g) * (1 + g) / (4 * std::numbers::pi * base * std::sqrt(base));
}

double henyey_greenstein_rms(double g, unsigned terms) {
    const double q = g * g;
    const double total = (1 + q) / ((1 - q) * (1 - q));
    double kept = 0, power = 1;
    for (unsigned l = 0, left = terms; left > 0; ++l, power *= q) {
        const unsigned take = std::min(left, 2 * l + 1);
        kept += take * power;
        left -= take;
    }
    return std::sqrt(std::max(0.0, 1 - kept / total));
}

}  // namespace opaline::bake
