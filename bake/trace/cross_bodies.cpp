#include "bake/trace/cross_bodies.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

// Changes the side from what one crossing of the triangle makes of it to what several do, where
// there are several.
void cross_all(const BodiesAt& bodies, std::span<const std::uint16_t> place_of,
               const BodyArrival& arrival, std::uint64_t& rays, FarSide& far) {
    constexpr float kAtEdge = 1e-4f, kGrazing = 0.1f;
    const float reach =
        bodies.touch() / std::max(kGrazing, std::abs(glm::dot(arrival.direction, arrival.flat)));
    const float back = std::min(0.5f * arrival.way, reach);
    int met = 0;
    bodies.visit_crossed(arrival.position - back * arrival.direction, arrival.direction,
                         back + reach, [&](std::uint32_t, bool) { ++met; });
    const bool is_alone =
        met <= 1 && std::min({arrival.u, arrival.v, 1 - arrival.u - arrival.v}) > kAtEdge;
    if (is_alone &&
        (far.side < 0 ? far.bodies.enter(arrival.place) : far.bodies.leave(arrival.place))) {
        return;
    }
    far.is_several = met > 1;
    far.lift = bodies.touch();
    ++rays;
    const glm::vec3 from = arrival.position + reach * arrival.direction;
    const std::optional<float> next = bodies.find_next(from, arrival.direction);
    far.bodies = next ? bodies_around(bodies, place_of, from + 0.5f * *next * arrival.direction)
                      : MediumStack();
}

}  // namespace

MediumStack bodies_around(const BodiesAt& bodies, std::span<const std::uint16_t> place_of,
                          glm::vec3 point) {
    std::vector<int> count;
    bodies.count(point, count);
    MediumStack around;
    for (std::size_t i = 0; i < count.size(); ++i) {
        const std::uint16_t place = place_of[bodies.order()[i]];
        for (int n = 0; n < count[i] && place != kNoPlace; ++n) {
            around.enter(place);
        }
    }
    return around;
}

MediumStack bodies_at_start(const BodiesAt& bodies, std::span<const std::uint16_t> place_of,
                            std::uint16_t own, glm::vec3 point) {
    const MediumStack around = bodies_around(bodies, place_of, point);
    return around.contains(own) ? around : MediumStack(own, 1);
}

FarSide find_far_side(const BodiesAt* meeting, std::span<const std::uint16_t> place_of,
                      const MediumStack& before, const BodyArrival& arrival, std::uint64_t& rays) {
    FarSide far{before, glm::dot(arrival.direction, arrival.flat) > 0 ? 1.0f : -1.0f,
                2 * arrival.error, true, false};
    if (meeting != nullptr) {
        cross_all(*meeting, place_of, arrival, rays, far);
    } else if (far.side > 0) {
        far.bodies.leave(arrival.place);
    } else {
        far.has_room = far.bodies.enter(arrival.place);
    }
    return far;
}

float boundary_transmittance(float cosine, float ratio) {
    return static_cast<float>(
        fresnel_transmittance(static_cast<double>(cosine), static_cast<double>(ratio)));
}

bool is_matched(float ratio) {
    return std::abs(ratio - 1) < 1e-5f;
}

Bend bend_at(glm::vec3 smooth, glm::vec3 flat, glm::vec3 direction, float ratio) {
    const auto bend_about = [&](glm::vec3 normal, float cosine) {
        const float bounded = std::min(1.0f, cosine);
        const auto beyond = static_cast<float>(
            refracted_cosine(static_cast<double>(bounded), static_cast<double>(ratio)));
        return Bend{direction - 2 * glm::dot(direction, normal) * normal,
                    glm::normalize((direction - bounded * normal) / ratio + beyond * normal),
                    boundary_transmittance(bounded, ratio)};
    };
    const float cosine = glm::dot(direction, smooth);
    Bend bend;
    if (cosine > 0) {
        bend = bend_about(smooth, cosine);
    }
    if (!(cosine > 0) || glm::dot(bend.reflected, flat) >= 0 ||
        (bend.passed > 0 && glm::dot(bend.refracted, flat) <= 0)) {
        bend = bend_about(flat, glm::dot(direction, flat));
    }
    bend.reflected = glm::normalize(bend.reflected);
    return bend;
}

}  // namespace opaline::bake
