#include "bake/effects/multiple/walks/walk_boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Changes the side from what one crossing of the triangle makes of it to what several do, where
// there are several.
void cross_all(const WalkSpace& space, const WalkFlight& flight, const WalkHit& hit,
               std::uint64_t& rays, FarSide& far) {
    constexpr float kAtEdge = 1e-4f, kGrazing = 0.1f;
    const BodiesAt& bodies = *space.bodies;
    const float reach =
        bodies.touch() / std::max(kGrazing, std::abs(glm::dot(flight.direction, hit.flat)));
    const float back = std::min(0.5f * flight.way, reach);
    int met = 0;
    bodies.visit_crossed(hit.position - back * flight.direction, flight.direction, back + reach,
                         [&](std::uint32_t, bool) { ++met; });
    const bool is_alone = met <= 1 && std::min({hit.u, hit.v, 1 - hit.u - hit.v}) > kAtEdge;
    if (is_alone && (far.side < 0 ? far.bodies.enter(hit.place) : far.bodies.leave(hit.place))) {
        return;
    }
    far.meets_other = far.meets_other || met > 1;
    far.lift = bodies.touch();
    ++rays;
    const glm::vec3 from = hit.position + reach * flight.direction;
    WalkHit next;
    far.bodies =
        find_hit(space, from, flight.direction, std::numeric_limits<float>::infinity(), next)
            ? bodies_around(space, 0.5f * (from + next.position))
            : MediumStack();
}

}  // namespace

float boundary_transmittance(float cosine, float ratio) {
    return static_cast<float>(
        fresnel_transmittance(static_cast<double>(cosine), static_cast<double>(ratio)));
}

glm::vec3 start_direction(const WalkSpace& space, const WalkStart& start, WalkRandom& random) {
    if (start.seen != glm::vec3(0)) return -start.seen;
    float cosine = 1, azimuth = 0;
    constexpr int kMostTries = 1000;  // one in a hundred is accepted at the most extreme index
    for (int i = 0; i < kMostTries; ++i) {
        cosine = std::sqrt(1 - random.next());
        azimuth = 2 * kPi * random.next();
        if (random.next() < boundary_transmittance(cosine, space.eta)) break;
        cosine = 1;
    }
    const auto inside = static_cast<float>(
        refracted_cosine(static_cast<double>(cosine), static_cast<double>(space.eta)));
    const float sine = std::sqrt(std::max(0.0f, 1 - inside * inside));
    const glm::vec3 tilted(sine * std::cos(azimuth), sine * std::sin(azimuth), -inside);
    const glm::vec3 direction = make_frame(start.normal).to_world(tilted);
    return glm::dot(direction, start.flat) < 0 ? direction
                                               : make_frame(start.flat).to_world(tilted);
}

FarSide find_far_side(const WalkSpace& space, const MediumStack& bodies, const WalkFlight& flight,
                      const WalkHit& hit, std::uint64_t& rays) {
    FarSide far{bodies, glm::dot(flight.direction, hit.flat) > 0 ? 1.0f : -1.0f, 2 * hit.error,
                true, !hit.is_own};
    if (space.bodies) {
        cross_all(space, flight, hit, rays, far);
    } else if (far.side > 0) {
        far.bodies.leave(hit.place);
    } else {
        far.has_room = far.bodies.enter(hit.place);
    }
    return far;
}

Bend bend_at(const WalkSpace& space, const WalkHit& hit, float side, glm::vec3 direction,
             float ratio) {
    const auto bend_about = [&](glm::vec3 normal, float cosine) {
        const float bounded = std::min(1.0f, cosine);
        const auto beyond = static_cast<float>(
            refracted_cosine(static_cast<double>(bounded), static_cast<double>(ratio)));
        return Bend{direction - 2 * glm::dot(direction, normal) * normal,
                    glm::normalize((direction - bounded * normal) / ratio + beyond * normal),
                    boundary_transmittance(bounded, ratio)};
    };
    const glm::vec3 flat = side * hit.flat, normal = side * smooth_normal(space, hit);
    const float cosine = glm::dot(direction, normal);
    Bend bend;
    if (cosine > 0) {
        bend = bend_about(normal, cosine);
    }
    if (!(cosine > 0) || glm::dot(bend.reflected, flat) >= 0 ||
        glm::dot(bend.refracted, flat) <= 0) {
        bend = bend_about(flat, glm::dot(direction, flat));
    }
    bend.reflected = glm::normalize(bend.reflected);
    return bend;
}

}  // namespace opaline::bake
