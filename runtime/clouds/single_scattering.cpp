#include "runtime/clouds/single_scattering.h"

#include <algorithm>
#include <cmath>

namespace opaline::runtime {
namespace {

// (1 - e^-d) / d
float mean_of_exponential(float d) {
    return d > 1e-6f ? -std::expm1(-d) / d : 1.0f;
}

// Deeper is as good as endless, and products stay finite.
constexpr float kDeepest = 1e6f;

}  // namespace

float taken_share(float depth) {
    return -std::expm1(-depth);
}

float reflected_source(float depth, float light, float view) {
    const float d = std::min(depth, kDeepest);
    const float x = d / view;
    if (x < 1e-30f) return 1;  // nothing there, and its limit
    return light / (light + view) * taken_share(x + d / light) / taken_share(x);
}

float transmitted_source(float depth, float light, float view) {
    const float d = std::min(depth, kDeepest);
    const float x_view = d / view, x_light = d / light;
    return std::exp(-std::min(x_view, x_light)) * mean_of_exponential(std::abs(x_light - x_view)) /
           mean_of_exponential(x_view);
}

}  // namespace opaline::runtime
