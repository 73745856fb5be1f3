#include "formats/opal/phase_table.h"

#include <numbers>

namespace opaline::formats {

double integrate_phase_table(std::span<const float> table) {
    // d(cosine) / d(coordinate) is linear within a step, as p' is: Simpson's rule is exact.
    const auto slope = [](double coordinate) {
        return std::min(coordinate, 256 - coordinate) / (128.0 * 64.0);
    };
    double sum = 0;
    for (std::size_t i = 0; i + 1 < table.size(); ++i) {
        const double from = static_cast<double>(table[i]), to = static_cast<double>(table[i + 1]);
        const double at = static_cast<double>(i);
        sum += (from * slope(at) + 2 * (from + to) * slope(at + 0.5) + to * slope(at + 1)) / 6;
    }
    return 2 * std::numbers::pi * sum;
}

}  // namespace opaline::formats
