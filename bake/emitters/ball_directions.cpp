#include "bake/emitters/ball_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"

namespace opaline::bake {

BallDirections::BallDirections(const Ball& ball, const glm::dvec3& point, const glm::dvec3& normal)
    : axis_(normal) {
    const glm::dvec3 way = ball.centre - point;
    const double distance = glm::length(way);
    if (!(distance > ball.radius)) return;
    const double sine = ball.radius / distance;
    // 1 - sqrt(1 - sine^2) without cancellation.
    const double cap = sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
    if (!(cap > 0) || cap > 0.5) return;
    axis_ = way / distance;
    cap_ = cap;
}

glm::dvec3 BallDirections::sample(double u, double v) const {
    const double z = cap_ > 0 ? 1 - u * cap_ : std::sqrt(1 - u);
    const double radius = std::sqrt(std::max(0.0, cap_ > 0 ? (1 - z) * (1 + z) : u));
    const double turn = 2 * std::numbers::pi * v;
    const Frame frame = make_frame(glm::vec3(axis_));
    return glm::normalize(radius * std::cos(turn) * glm::dvec3(frame.to_world(glm::vec3(1, 0, 0))) +
                          radius * std::sin(turn) * glm::dvec3(frame.to_world(glm::vec3(0, 1, 0))) +
                          z * axis_);
}

double BallDirections::pdf(const glm::dvec3& direction) const {
    const double cosine = glm::dot(direction, axis_);
    if (!(cap_ > 0)) return std::max(0.0, cosine) * std::numbers::inv_pi;
    return 1 - cosine <= cap_ ? 1 / (2 * std::numbers::pi * cap_) : 0;
}

}  // namespace opaline::bake
