#include "bake/scene/punctual_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace opaline::bake {
namespace {

using formats::Light;

/// Least width of a spot's edge, in cosines: of the extension.
constexpr float kLeastEdge = 0.001f;

float spot_factor(const Light& light, float cosine) {
    const float outer = std::cos(light.outer_cone);
    const float edge = std::max(kLeastEdge, std::cos(light.inner_cone) - outer);
    const float share = std::clamp((cosine - outer) / edge, 0.0f, 1.0f);
    return share * share;
}

float range_factor(const Light& light, float distance) {
    if (!(light.range > 0)) return 1;
    const float ratio = distance / light.range, square = ratio * ratio;
    return std::max(0.0f, 1 - square * square);
}

}  // namespace

ArrivingLight light_at(const Light& light, glm::vec3 position) {
    if (light.type == Light::Type::directional) {
        return {-light.direction, std::numeric_limits<float>::infinity(), light.intensity};
    }
    const glm::vec3 way = light.position - position;
    const float distance = glm::length(way);
    if (!(distance > 0)) {
        return {};
    }
    ArrivingLight at{way / distance, distance, {}};
    const float spot = light.type == Light::Type::spot
                           ? spot_factor(light, -glm::dot(at.to_light, light.direction))
                           : 1.0f;
    // Divided twice, so that the square of a tiny distance does not underflow.
    at.irradiance = (spot * range_factor(light, distance) / distance / distance) * light.intensity;
    const bool is_finite = std::isfinite(at.irradiance.r) && std::isfinite(at.irradiance.g) &&
                           std::isfinite(at.irradiance.b);
    return is_finite ? at : ArrivingLight{};
}

double flux_per_intensity(const Light& light) {
    constexpr double kPi = std::numbers::pi;
    if (light.type == Light::Type::point) return 4 * kPi;
    const double outer = std::cos(static_cast<double>(light.outer_cone));
    const double inner = std::cos(static_cast<double>(light.inner_cone));
    const double edge = std::max(static_cast<double>(kLeastEdge), inner - outer);
    // Over cosines from `outer` the factor rises as a square to 1 at outer + edge, which may lie
    // beyond 1.
    const double rise = std::min(edge, 1 - outer);
    const double square = rise * rise * rise / (3 * edge * edge);
    return 2 * kPi * (square + std::max(0.0, 1 - outer - edge));
}

}  // namespace opaline::bake
