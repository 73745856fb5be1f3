#include "bake/reference/events.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"

namespace opaline::bake {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kForever = std::numeric_limits<float>::infinity();

bool count_event(const PathSpace& space, Path& path) {
    return ++path.events <= space.options.max_depth;
}

// The direction at cosine `cosine` to the unit vector n, with azimuth 2 pi u.
glm::vec3 direction_about(glm::vec3 n, float cosine, float u) {
    const float sine = std::sqrt(std::max(0.0f, (1 - cosine) * (1 + cosine)));
    const float phi = 2 * kPi * u;
    const glm::vec3 d =
        make_frame(n).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
    // One Newton step renormalises, so that rounding does not accumulate over a long walk.
    return (1.5f - 0.5f * glm::dot(d, d)) * d;
}

/// Transmittance of a straight line to the sky. 0 if anything but a boundary between equal indices
/// is in the way, or if the path would end in no requested term.
glm::vec3 see_sky(const PathSpace& space, RayOrigin from, glm::vec3 direction, MediumStack stack,
                  PathState state) {
    const ReferenceScene& scene = space.scene;
    const HitScene& surfaces = scene.surfaces;
    if (!scene.has_matched_boundary) {
        return stack.empty() && has_any(term_of(state), space.options.terms) &&
                       !surfaces.is_blocked(from, direction)
                   ? glm::vec3(1)
                   : glm::vec3(0);
    }
    glm::vec3 passing(1);
    while (const auto hit = surfaces.closest_hit(from, direction, kForever)) {
        if (!stack.empty()) {
            passing *= glm::exp(-scene.media[stack.top()].sigma_t * hit->distance);
        }
        const std::uint32_t material = surfaces.scene().primitives[hit->primitive].material;
        const std::uint32_t medium = scene.medium_of[material];
        if (medium == formats::kNone) {
            return glm::vec3(0);
        }
        const bool was_out = stack.empty();
        const std::uint32_t before = stack.top();
        glm::dot(direction, hit->flat) < 0 ? stack.enter(medium) : stack.leave(medium);
        if (before != stack.top()) {
            const float eta = before == formats::kNone ? 1 : scene.media[before].eta;
            const float next = stack.empty() ? 1 : scene.media[stack.top()].eta;
            if (!is_matched(next / eta)) {
                return glm::vec3(0);
            }
            state = after_crossing(state, stack.empty());
            if (was_out) {
                passing *= base_color_at(surfaces.scene(), *hit);
            }
        }
        from = leave_surface(*hit, direction);
    }
    return stack.empty() && has_any(term_of(state), space.options.terms) ? passing : glm::vec3(0);
}

/// Direct light at an event, sampled from the light. `density(d)`: density of the event's own
/// sampling over solid angle, which equals its response for unit throughput.
template <class Density>
void gather_light(const PathSpace& space, Path& path, const RayOrigin& from, RandomStream& random,
                  Density&& density) {
    const glm::vec3 d = sample_light(space.light, random);
    if (d == glm::vec3(0)) {
        return;
    }
    const float response = density(d);
    if (!(response > 0)) {
        return;
    }
    const glm::vec3 passing = see_sky(space, from, d, path.stack, path.state);
    if (passing != glm::vec3(0)) {
        path.radiance += path.beta * passing * eval_light(space.light, d) *
                         (response / (pdf_light(space.light, d) + response));
    }
}

/// Russian roulette below the throughput `little`; survivors carry `little`. Paths in a closed room
/// of albedo 1 end as well.
///
/// In bodies, roulette at every event (kInBodies) is up to 1.7 times as efficient as a threshold of
/// 0.1 (tests/bench/reference_bench.cpp), because the light at the end of a path varies more than
/// its throughput. Dark surfaces would save a ray but lose their stratified samples.
constexpr float kInBodies = 1, kAtSurfaces = 0.1f;
bool survives(Path& path, float little, RandomStream& random) {
    constexpr float kPatience = 0.9999f;
    constexpr std::uint32_t kMany = 200000;
    const float most = std::max({path.beta.x, path.beta.y, path.beta.z});
    float chance = std::min(1.0f, most / little);
    if (path.events > kMany) {
        chance = std::min(chance, kPatience);
    }
    if (chance < 1) {
        if (!(random.next() < chance)) {
            return false;
        }
        path.beta /= chance;
    }
    return true;
}

}  // namespace

bool reflect_diffusely(const PathSpace& space, Path& path, const RayOrigin& from, glm::vec3 normal,
                       glm::vec3 flat, glm::vec3 albedo, RandomStream& random) {
    path.state = after_diffuse(path.state);
    path.beta *= albedo;
    if (!count_event(space, path) || path.beta == glm::vec3(0) || !is_wanted(space, path.state)) {
        return false;
    }
    const auto is_above = [&](glm::vec3 d) {
        return flat == glm::vec3(0) || glm::dot(d, flat) > 0;
    };
    gather_light(space, path, from, random,
                 [&](glm::vec3 d) { return is_above(d) ? glm::dot(d, normal) / kPi : 0.0f; });
    const float cosine = std::sqrt(1 - random.next());
    path.direction = direction_about(normal, cosine, random.next());
    path.origin = from;
    path.pdf = cosine / kPi;
    return is_above(path.direction) && survives(path, kAtSurfaces, random);
}

void pass_boundary(Path& path, const Crossing& crossing) {
    if (path.stack.empty()) {
        path.beta *= crossing.color;
    }
    path.stack = crossing.beyond;
    path.state = after_crossing(path.state, path.stack.empty());
    path.origin = crossing.far;
}

bool reflect_or_refract(const PathSpace& space, Path& path, const Crossing& crossing,
                        RandomStream& random) {
    const float reflectance = crossing.split.reflectance;
    const bool may_reflect = reflectance > 0 && is_wanted(space, after_reflection(path.state));
    const bool may_pass =
        reflectance < 1 && is_wanted(space, after_crossing(path.state, crossing.beyond.empty()));
    if (!count_event(space, path) || (!may_reflect && !may_pass)) {
        return false;
    }
    path.pdf = 0;
    bool reflects = may_reflect;
    if (may_reflect && may_pass) {
        reflects = random.next() < reflectance;
    } else {
        path.beta *= may_reflect ? reflectance : 1 - reflectance;
    }
    if (reflects) {
        path.direction = crossing.split.reflected;
        path.origin = crossing.near;
        path.state = after_reflection(path.state);
    } else {
        path.direction = crossing.split.transmitted;
        pass_boundary(path, crossing);
    }
    return path.beta != glm::vec3(0) && survives(path, kInBodies, random);
}

bool scatter(const PathSpace& space, Path& path, glm::vec3 at, RandomStream& random) {
    const PhaseSampler& phase = space.scene.media[path.stack.top()].phase;
    path.state = after_scattering(path.state);
    if (!count_event(space, path) || path.beta == glm::vec3(0) || !is_wanted(space, path.state)) {
        return false;
    }
    path.origin = {at};
    path.pdf = 0;
    const glm::vec3 before = path.direction;
    if (space.scene.has_matched_boundary) {
        gather_light(space, path, path.origin, random,
                     [&](glm::vec3 d) { return pdf_phase(phase, glm::dot(before, d)); });
    }
    const float cosine = sample_phase_cosine(phase, [&] { return random.next(); });
    path.direction = direction_about(before, cosine, random.next());
    if (space.scene.has_matched_boundary) {
        path.pdf = pdf_phase(phase, cosine);
    }
    return survives(path, kInBodies, random);
}

}  // namespace opaline::bake
