#include "bake/effects/volumes/degree_rate.h"

#include <cmath>

#include "bake/trace/density/scaled_phase.h"

namespace opaline::bake {

double rate_of_degree(double mean_cosine) {
    formats::PhaseFunction phase;
    phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    phase.g = static_cast<float>(mean_cosine);
    const ScaledPhase scaled = scale_phase(phase);
    if (scaled.degree < 2) return 0;
    const auto square = [&](unsigned l) {
        const double lambda = scaled.lambda[l];
        return (2 * l + 1) * lambda * lambda;
    };
    const double finest = square(scaled.degree);
    double coarsest = 0;
    for (unsigned l = scaled.degree; l > 0; --l) {
        coarsest += square(l);
    }
    return 0.5 * std::log(finest / coarsest) / (scaled.degree - 1);
}

}  // namespace opaline::bake
