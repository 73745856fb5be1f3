#include "bake/physics/scattering_color.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

constexpr double kSquare = 0.139, kBelow = 1.17;

}  // namespace

double scattering_color(double albedo, double g) {
    const double s = std::sqrt(std::max(0.0, (1 - albedo) / (1 - g * albedo)));
    return (1 - s) * (1 - kSquare * s) / (1 + kBelow * s);
}

double albedo_of_color(double color, double g) {
    if (!(color > 0)) return 0;
    // 0.139 s^2 - b s + 1 - colour = 0, its smaller root without a difference of large numbers.
    const double b = 1 + kSquare + kBelow * color, c = 1 - color;
    const double s = 2 * c / (b + std::sqrt(b * b - 4 * kSquare * c));
    return std::clamp((1 - s * s) / (1 - g * s * s), 0.0, 1.0);
}

}  // namespace opaline::bake
