#include "bake/physics/slab/low_orders.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

// Past these, all is at its limit, and products of them are finite.
constexpr double kGrazing = 1e-12, kDeepest = 1e12;

/// (1 - e^-d) / d
double phi(double d) {
    return d > 0 ? -std::expm1(-d) / d : 1;
}

/// 1 - (1 + x) e^-x, which is x^2 / 2 - x^3 / 3 + ... and would cancel.
double second_order(double x) {
    constexpr double kSeriesBelow = 0.3;
    if (x >= kSeriesBelow) return 1 - (1 + x) * std::exp(-x);
    double sum = 0, power = x;  // x^n / n!, with its sign
    for (int n = 2; n < 14; ++n) {
        power *= -x / n;
        sum -= (n - 1) * power;
    }
    return sum;
}

/// Slant optical depths of light and view.
struct SlantDepths {
    double depth, light, view;     ///< cosines, above 0
    double sum, less, difference;  ///< of both slant depths; the lesser one
};

SlantDepths slant_depths(double depth, double light, double view) {
    const double d = std::min(depth, kDeepest);
    const double l = std::max(light, kGrazing), v = std::max(view, kGrazing);
    return {d, l, v, d / l + d / v, d / std::max(l, v), std::abs(d / l - d / v)};
}

}  // namespace

double reflected_once(double depth, double light, double view) {
    const SlantDepths s = slant_depths(depth, light, view);
    return s.light / (s.light + s.view) * -std::expm1(-s.sum);
}

double transmitted_once(double depth, double light, double view) {
    // Where light and view are near each other the quotient of [Bouthors2006] is 0 / 0.
    const SlantDepths s = slant_depths(depth, light, view);
    return s.depth / s.view * std::exp(-s.less) * phi(s.difference);
}

double reflected_twice(double depth, double light, double view) {
    const SlantDepths s = slant_depths(depth, light, view);
    return s.light / (s.light + s.view) * second_order(s.sum) / 2;
}

double transmitted_twice(double depth, double light, double view) {
    const SlantDepths s = slant_depths(depth, light, view);
    const double rest = s.difference > 0 ? second_order(s.difference) / s.difference : 0;
    return s.depth / s.view * std::exp(-s.less) * (s.less * phi(s.difference) + rest) / 2;
}

double spread_profile(double a, double view) {
    const double mu = std::max(view, kGrazing);
    constexpr double kThin = 1e-15;  // of view: then 1 - e^(-a / mu) is a / mu
    if (a < kThin * mu) return 1 / (2 * mu);
    // 1 - 2 E_3(a) = 1 - e^-a + a e^-a - a^2 E_1(a)
    const double taken = -std::expm1(-a) + a * std::exp(-a) + a * a * std::expint(-a);
    return -std::expm1(-a / mu) / taken;
}

}  // namespace opaline::bake
