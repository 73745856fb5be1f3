#include "bake/reference/path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/reference/boundary.h"

namespace opaline::bake {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kForever = std::numeric_limits<float>::infinity();

/// A path as far as it has been walked, from the eye.
struct Path {
    RayOrigin origin;
    glm::vec3 direction{0};
    glm::vec3 beta{1};  ///< throughput
    MediumStack stack;
    PathState state;
    std::uint32_t events = 0;
    float pdf = 0;  ///< [1/sr] of `direction`, where the light was sampled at its start too; else 0
    glm::vec3 radiance{0};
    bool lost = false;
};

bool is_wanted(const PathSpace& space, PathState state) {
    return (reachable_terms(state) & space.options.terms) != 0;
}

bool count_event(const PathSpace& space, Path& path) {
    return ++path.events <= space.options.max_depth;
}

// Unit vectors at right angles to n.
void make_frame(glm::vec3 n, glm::vec3& t, glm::vec3& b) {
    t = glm::normalize(
        glm::cross(std::abs(n.x) > 0.7f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), n));
    b = glm::cross(n, t);
}

glm::vec3 direction_about(glm::vec3 axis, float cosine, float u) {
    glm::vec3 t, b;
    make_frame(axis, t, b);
    const float sine = std::sqrt(std::max(0.0f, (1 - cosine) * (1 + cosine)));
    const float phi = 2 * kPi * u;
    return glm::normalize(cosine * axis + sine * (std::cos(phi) * t + std::sin(phi) * b));
}

/// What a straight line to the sky lets through, 0 where anything but a boundary between equal
/// indices is in its way or where it ends in no wanted term.
glm::vec3 see_sky(const PathSpace& space, RayOrigin from, glm::vec3 direction, MediumStack stack,
                  PathState state) {
    const ReferenceScene& scene = space.scene;
    const HitScene& surfaces = scene.surfaces;
    if (!scene.has_matched_boundary) {
        return stack.empty() && (term_of(state) & space.options.terms) != 0 &&
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
    return stack.empty() && (term_of(state) & space.options.terms) != 0 ? passing : glm::vec3(0);
}

/// Light that arrives straight from the sky at an event, sampled from the light. `density(d)`: of
/// the event's own sampling over solid angle, which is also its response for unit throughput.
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

/// Paths that carry little end early, and the survivors carry more. Paths in a dark room of albedo
/// 1 end as well, some day.
bool survives(Path& path, RandomStream& random) {
    constexpr float kLittle = 0.1f, kPatience = 0.9999f;
    constexpr std::uint32_t kMany = 200000;
    const float most = std::max({path.beta.x, path.beta.y, path.beta.z});
    float chance = std::min(1.0f, most / kLittle);
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

/// A diffuse surface. Normals face the path; `flat` may be {0,0,0} at a vertex, which lies on
/// several triangles. False: the path ends.
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
    return is_above(path.direction) && survives(path, random);
}

/// Two sides of a boundary that a path has arrived at.
struct Crossing {
    BoundarySplit split;
    RayOrigin near, far;  ///< where rays start on this side and beyond
    MediumStack beyond;   ///< bodies on the far side
    glm::vec3 color{1};   ///< what passes into a body from outside is multiplied with
};

void pass_boundary(Path& path, const Crossing& crossing) {
    if (path.stack.empty()) {
        path.beta *= crossing.color;
    }
    path.stack = crossing.beyond;
    path.state = after_crossing(path.state, path.stack.empty());
    path.origin = crossing.far;
}

/// A boundary between different indices: the path is reflected or passes, by chance, or surely
/// where the other way leads to no wanted term. False: the path ends.
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
    return path.beta != glm::vec3(0) && survives(path, random);
}

float index_of(const ReferenceScene& scene, const MediumStack& stack) {
    return stack.empty() ? 1 : scene.media[stack.top()].eta;
}

bool meet_boundary(const PathSpace& space, Path& path, const SurfaceHit& hit, std::uint32_t medium,
                   RandomStream& random) {
    const ReferenceScene& scene = space.scene;
    const bool enters = glm::dot(path.direction, hit.flat) < 0;
    Crossing crossing;
    crossing.beyond = path.stack;
    enters ? crossing.beyond.enter(medium) : crossing.beyond.leave(medium);
    crossing.far = leave_surface(hit, path.direction);
    if (path.stack.top() == crossing.beyond.top()) {
        // A shell inside a body of the same medium, or one that overlaps: nothing to be seen.
        path.stack = crossing.beyond;
        path.origin = crossing.far;
        return true;
    }
    crossing.color = base_color_at(scene.surfaces.scene(), hit);
    const float ratio = index_of(scene, crossing.beyond) / index_of(scene, path.stack);
    if (is_matched(ratio)) {
        pass_boundary(path, crossing);
        return path.beta != glm::vec3(0) && is_wanted(space, path.state);
    }
    const float side = enters ? 1.0f : -1.0f;
    crossing.split =
        split_at_smooth_boundary(path.direction, side * hit.smooth, side * hit.flat, ratio);
    crossing.near = leave_surface(hit, crossing.split.reflected);
    return reflect_or_refract(space, path, crossing, random);
}

bool meet_surface(const PathSpace& space, Path& path, const SurfaceHit& hit, RandomStream& random) {
    const formats::Scene& scene = space.scene.surfaces.scene();
    const std::uint32_t number = scene.primitives[hit.primitive].material;
    if (const std::uint32_t medium = space.scene.medium_of[number]; medium != formats::kNone) {
        return meet_boundary(space, path, hit, medium, random);
    }
    const bool back = glm::dot(path.direction, hit.flat) > 0;
    if (back && !scene.materials[number].double_sided) {
        if (path.state.stage == PathState::Stage::camera) {
            // Pictures leave such backs out; to other light they are black.
            path.origin = leave_surface(hit, path.direction);
            return true;
        }
        return false;
    }
    const float side = back ? -1.0f : 1.0f;
    return reflect_diffusely(space, path, leave_surface(hit, side * hit.flat), side * hit.smooth,
                             side * hit.flat, base_color_at(scene, hit), random);
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
    return survives(path, random);
}

void reach_sky(const PathSpace& space, Path& path) {
    const bool is_background = path.state.stage == PathState::Stage::camera;
    if (!path.stack.empty()) {
        path.lost = true;
    } else if (is_background ? space.options.terms == term::kAll
                             : (term_of(path.state) & space.options.terms) != 0) {
        const float weight =
            path.pdf > 0 ? path.pdf / (path.pdf + pdf_light(space.light, path.direction)) : 1.0f;
        path.radiance += weight * path.beta * eval_light(space.light, path.direction);
    }
}

// One flight and what ends it. False: the path ends.
bool advance(const PathSpace& space, Path& path, RandomStream& random) {
    const auto find = [&](float reach) {
        return space.scene.surfaces.closest_hit(path.origin, path.direction, reach);
    };
    std::optional<SurfaceHit> hit;
    if (path.stack.empty()) {
        hit = find(kForever);
    } else {
        const Flight flight =
            sample_flight(space.scene.media[path.stack.top()], path.beta, random, find);
        path.beta *= flight.weight;
        hit = flight.surface;
        if (!hit && !std::isinf(flight.distance)) {
            return scatter(space, path, path.origin.position + flight.distance * path.direction,
                           random);
        }
    }
    if (!hit) {
        reach_sky(space, path);
        return false;
    }
    return meet_surface(space, path, *hit, random);
}

PathSample finish(const PathSpace& space, Path& path, RandomStream& random) {
    while (advance(space, path, random)) {
    }
    const float sum = path.radiance.x + path.radiance.y + path.radiance.z;
    if (!std::isfinite(sum)) {
        return {glm::vec3(0), true};
    }
    return {path.radiance, path.lost};
}

}  // namespace

PathSample trace_ray(const PathSpace& space, glm::vec3 origin, glm::vec3 direction,
                     RandomStream& random) {
    Path path;
    path.origin = {origin};
    path.direction = direction;
    return finish(space, path, random);
}

PathSample trace_receiver(const PathSpace& space, const ReferenceReceiver& receiver,
                          RandomStream& random) {
    const formats::Scene& scene = space.scene.surfaces.scene();
    const formats::Material& material =
        scene.materials[scene.primitives[receiver.primitive].material];
    glm::vec3 normal = receiver.normal;
    RayOrigin outside{receiver.outside}, inside{receiver.inside};
    if (glm::dot(normal, receiver.to_eye) < 0 && material.double_sided) {
        normal = -normal;
        std::swap(outside, inside);
    }
    const bool opaque = receiver.medium == formats::kNone;
    // Diffuse rows look the same from everywhere.
    if (normal == glm::vec3(0) || (!opaque && !(glm::dot(normal, receiver.to_eye) > 0))) {
        return {};
    }
    Path path;
    path.direction = -receiver.to_eye;
    bool walks = false;
    if (opaque) {
        walks = reflect_diffusely(space, path, outside, normal, glm::vec3(0), receiver.base_color,
                                  random);
    } else {
        Crossing crossing;
        const float ratio = space.scene.media[receiver.medium].eta;
        crossing.split = split_at_boundary(path.direction, normal, ratio);
        crossing.near = outside;
        crossing.far = inside;
        crossing.beyond.enter(receiver.medium);
        crossing.color = receiver.base_color;
        if (is_matched(ratio)) {
            pass_boundary(path, crossing);
            walks = path.beta != glm::vec3(0) && is_wanted(space, path.state);
        } else {
            walks = reflect_or_refract(space, path, crossing, random);
        }
    }
    return walks ? finish(space, path, random) : PathSample{path.radiance, false};
}

}  // namespace opaline::bake
