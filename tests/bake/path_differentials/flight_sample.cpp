#include "tests/bake/path_differentials/flight_sample.h"

#include <cmath>

namespace opaline::bake {

FlightSample sample_flight_distance(double sigma, double u) {
    const double t = -std::log1p(-u) / sigma;
    return {t, 1 / (sigma * (1 - u)), -t / sigma, 0};
}

FlightSample sample_bounded_distance(double sigma, double length, double u) {
    const double x = sigma * length, taken = -u * std::expm1(-x);
    const double dt_dlength = u * std::exp(-x) / (1 - taken);
    if (x < 1e-4) {
        const double b = u * (1 - u), odd = 1 - 2 * u;
        return {length * (u - b * x / 2 + b * odd * x * x / 6),
                length * (1 - odd * x / 2 + (odd * odd - 2 * b) * x * x / 6),
                length * length * (-b / 2 + b * odd * x / 3 - b * (1 - 6 * b) * x * x / 8),
                dt_dlength};
    }
    const double t = -std::log1p(-taken) / sigma;
    return {t, -std::expm1(-x) / (sigma * (1 - taken)), (length * dt_dlength - t) / sigma,
            dt_dlength};
}

}  // namespace opaline::bake
