#include "bake/reference/events.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/reference/gather_light.h"
#include "bake/reference/glossy_brdf.h"
#include "bake/reference/rough_boundary.h"

namespace opaline::bake {
namespace {

bool count_event(const PathSpace& space, Path& path) {
    path.passed = 0;
    return ++path.events <= space.options.max_depth;
}

// False where no texture is looked up any more: past the last event only emission counts.
bool goes_on_filtering(const PathSpace& space, Path& path) {
    if (path.events >= space.options.max_depth && space.scene.lamps.triangles.empty()) {
        path.filter.reset();
    }
    return path.filter.has_value();
}

// The direction at cosine `cosine` to the unit vector n, with azimuth 2 pi u.
glm::vec3 direction_about(glm::vec3 n, float cosine, float u) {
    const float sine = std::sqrt(std::max(0.0f, (1 - cosine) * (1 + cosine)));
    const float phi = 2 * std::numbers::pi_v<float> * u;
    const glm::vec3 d =
        make_frame(n).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
    // One Newton step renormalises, so that rounding does not accumulate over a long walk.
    return (1.5f - 0.5f * glm::dot(d, d)) * d;
}

/// An event that is sampled in proportion to its response for unit throughput.
LobeValue even_response(float density) {
    return {glm::vec3(density), density};
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
        if (!(random.next() < chance)) return false;
        path.beta /= chance;
    }
    return true;
}

bool is_above(const OpaquePoint& point, glm::vec3 d) {
    return point.flat == glm::vec3(0) || glm::dot(d, point.flat) > 0;
}

bool reflect_diffusely(const PathSpace& space, Path& path, const OpaquePoint& point,
                       glm::vec3 albedo, RandomStream& random) {
    path.state = after_diffuse(path.state);
    path.beta *= albedo;
    if (!count_event(space, path) || path.beta == glm::vec3(0) || !is_wanted(space, path.state)) {
        return false;
    }
    const glm::vec2 uv = random.next_pair();
    gather_light(space, path, point.from, true, random, [&](glm::vec3 d) {
        return even_response(
            is_above(point, d) ? glm::dot(d, point.normal) / std::numbers::pi_v<float> : 0.0f);
    });
    const float cosine = std::sqrt(1 - uv.x);
    path.direction = direction_about(point.normal, cosine, uv.y);
    if (goes_on_filtering(space, path)) {
        path.filter->scatter_diffusely(point.normal, path.direction);
    }
    path.origin = point.from;
    path.pdf = cosine / std::numbers::pi_v<float>;
    return is_above(point, path.direction) && survives(path, kAtSurfaces, random);
}

bool reflect_as_mirror(const PathSpace& space, Path& path, const OpaquePoint& point,
                       const GlossyBrdf& brdf, RandomStream& random) {
    path.state = after_mirror(path.state);
    if (!count_event(space, path)) return false;
    const glm::vec2 uv = random.next_pair();
    gather_light(space, path, point.from, true, random, [&](glm::vec3 d) {
        return is_above(point, d) ? eval_mirrored(brdf, d) : LobeValue{};
    });
    const auto sample = sample_mirrored(brdf, uv.x, uv.y);
    if (!sample || !is_above(point, sample->direction)) return false;
    path.beta *= sample->weight;
    if (goes_on_filtering(space, path)) {
        path.filter->scatter_on_facets(path.direction, point.normal, static_cast<float>(brdf.alpha),
                                       sample->direction);
    }
    path.direction = sample->direction;
    path.origin = point.from;
    path.pdf = sample->pdf;
    return path.beta != glm::vec3(0) && survives(path, kAtSurfaces, random);
}

float mean(glm::vec3 v) {
    return (v.x + v.y + v.z) / 3;
}

// The same point for light that comes from the other side.
OpaquePoint turned(const OpaquePoint& point) {
    return {point.behind, point.from, -point.normal, -point.flat, point.surface, false};
}

bool scatter_diffusely(const PathSpace& space, Path& path, const OpaquePoint& point,
                       glm::vec3 albedo, RandomStream& random) {
    const glm::vec3 reflected = albedo * point.surface.reflect,
                    transmitted = albedo * point.surface.transmit;
    const float there = mean(transmitted), here = mean(reflected);
    if (!(there > 0)) return reflect_diffusely(space, path, point, reflected, random);
    const float chance = there / (there + here);
    return here > 0 && !(random.next() < chance)
               ? reflect_diffusely(space, path, point, reflected / (1 - chance), random)
               : reflect_diffusely(space, path, turned(point), transmitted / chance, random);
}

// A new direction by a phase function. `sees_sky`: straight lines from here may reach the sky, so
// that it is sampled too.
void turn(const PathSpace& space, Path& path, glm::vec3 at, const PhaseSampler& phase,
          bool sees_sky, RandomStream& random) {
    path.origin = {at};
    path.pdf = 0;
    random.start_event();
    path.filter.reset();  // not followed in volumes
    const glm::vec3 before = path.direction;
    const bool sees_light = sees_sky || counts_lamps(space);
    if (sees_light) {
        gather_light(space, path, path.origin, sees_sky, random, [&](glm::vec3 d) {
            return even_response(pdf_phase(phase, glm::dot(before, d)));
        });
    }
    const float cosine = sample_phase_cosine(phase, [&] { return random.next(); });
    path.direction = direction_about(before, cosine, random.next());
    if (sees_light) {
        path.pdf = pdf_phase(phase, cosine);
    }
}

// Facets of a rough boundary reflect or refract; light is sampled on both sides.
bool cross_facets(const PathSpace& space, Path& path, const Crossing& crossing,
                  RandomStream& random) {
    RoughBoundary boundary =
        make_rough_boundary(crossing.normal, -path.direction, crossing.alpha, crossing.ratio);
    const LightSide here{crossing.near, path.stack, after_reflection(path.state)};
    const LightSide beyond{crossing.far, crossing.beyond,
                           after_crossing(path.state, crossing.beyond.empty())};
    boundary.reflects = !crossing.is_own_mirror && is_wanted(space, here.state);
    boundary.transmits = is_wanted(space, beyond.state);
    if (!count_event(space, path) || (!boundary.reflects && !boundary.transmits)) return false;
    random.start_event();
    const glm::vec2 uv = random.next_pair();
    const float choice = random.next();
    const glm::vec3 color = path.stack.empty() ? crossing.color : glm::vec3(1);
    // The interpolated normal may take a direction to the other side of the triangle.
    const auto is_on_side = [&](glm::vec3 d, bool transmits) {
        const float along = glm::dot(d, crossing.flat);
        return crossing.flat == glm::vec3(0) || (transmits ? along < 0 : along > 0);
    };
    const bool sees_sky =
        here.stack.empty() || beyond.stack.empty() || space.scene.has_matched_boundary;
    gather_from_sides(space, path, crossing.near.position, sees_sky, random,
                      [&](glm::vec3 d) -> SidedLobe {
                          const bool transmits = glm::dot(d, crossing.normal) < 0;
                          if (!is_on_side(d, transmits)) {
                              return {};
                          }
                          const BoundaryValue value = eval_rough_boundary(boundary, d);
                          return {{value.response * (transmits ? color : glm::vec3(1)), value.pdf},
                                  transmits ? &beyond : &here};
                      });
    const auto sample = sample_rough_boundary(boundary, uv.x, uv.y, choice);
    if (!sample || !is_on_side(sample->direction, sample->transmits)) return false;
    if (goes_on_filtering(space, path)) {
        path.filter->scatter_on_facets(path.direction, crossing.normal, crossing.alpha,
                                       sample->direction, sample->transmits ? crossing.ratio : 0);
    }
    path.beta *= sample->weight;
    path.direction = sample->direction;
    path.pdf = sample->pdf;
    if (sample->transmits) {
        pass_boundary(path, crossing);
    } else {
        path.origin = crossing.near;
        path.state = here.state;
    }
    return path.beta != glm::vec3(0) && survives(path, kAtSurfaces, random);
}

}  // namespace

bool reflect_at_surface(const PathSpace& space, Path& path, const OpaquePoint& point,
                        RandomStream& random) {
    random.start_event();
    if (point.surface.is_diffuse()) {
        return scatter_diffusely(space, path, point, point.surface.base_color, random);
    }
    const GlossyBrdf brdf = make_glossy_brdf(point.surface, point.normal, -path.direction);
    const bool may_mirror = !point.is_own_mirror && is_wanted(space, after_mirror(path.state));
    const float mirrored = may_mirror ? mean(brdf.mirrored_albedo) : 0;
    const float diffuse =
        is_wanted(space, after_diffuse(path.state)) ? mean(brdf.diffuse_albedo) : 0;
    if (!(mirrored + diffuse > 0)) return false;
    bool mirrors = mirrored > 0;
    if (mirrored > 0 && diffuse > 0) {
        const float chance = mirrored / (mirrored + diffuse);
        mirrors = random.next() < chance;
        path.beta /= mirrors ? chance : 1 - chance;
    }
    return mirrors ? reflect_as_mirror(space, path, point, brdf, random)
                   : scatter_diffusely(space, path, point, brdf.diffuse_albedo, random);
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
    if (crossing.alpha > 0) return cross_facets(space, path, crossing, random);
    const float reflectance = crossing.split.reflectance;
    const bool may_reflect = reflectance > 0 && is_wanted(space, after_reflection(path.state));
    const bool may_pass =
        reflectance < 1 && is_wanted(space, after_crossing(path.state, crossing.beyond.empty()));
    if (!count_event(space, path) || (!may_reflect && !may_pass)) return false;
    path.pdf = 0;
    random.start_event();
    bool reflects = may_reflect;
    if (may_reflect && may_pass) {
        reflects = random.next() < reflectance;
    } else {
        path.beta *= may_reflect ? reflectance : 1 - reflectance;
    }
    if (path.filter) {
        reflects ? path.filter->mirror(path.direction, crossing.normal)
                 : path.filter->refract(path.direction, crossing.normal, crossing.ratio);
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
    turn(space, path, at, phase, space.scene.has_matched_boundary, random);
    return survives(path, kInBodies, random);
}

bool scatter_in_volume(const PathSpace& space, Path& path, glm::vec3 at, std::uint32_t volume,
                       RandomStream& random) {
    const bool keeps_term = space.options.through_volumes && is_on_way_to_sky(path.state);
    path.state = keeps_term ? path.state : after_volume(path.state);
    path.state.by_volume = path.state.by_volume || keeps_term;
    if (!count_event(space, path) || path.beta == glm::vec3(0) || !is_wanted(space, path.state)) {
        return false;
    }
    turn(space, path, at, space.scene.volumes.volumes[volume].phase, true, random);
    return survives(path, kAtSurfaces, random);
}

}  // namespace opaline::bake
