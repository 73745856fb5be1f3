#include "bake/reference/path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/reference/events.h"
#include "bake/reference/light_line.h"
#include "bake/reference/rough_boundary.h"
#include "bake/reference/shading_normal.h"
#include "bake/reference/volume_flight.h"
#include "bake/scene/base_color.h"

namespace opaline::bake {
namespace {

constexpr float kForever = std::numeric_limits<float>::infinity();

float index_of(const ReferenceScene& scene, const SurroundingMedia& stack) {
    return stack.empty() ? 1 : scene.media[stack.top()].eta;
}

// A straight line goes on. False: the path is held up where more faces meet than it can tell apart.
bool pass_surface(Path& path, const RayOrigin& beyond) {
    path.origin = go_straight_on(path.origin, beyond);
    path.lost = ++path.passed > kMostSteps;
    return !path.lost;
}

// The same place as `other`, on its triangles as well.
RayOrigin start_on(const RayOrigin& other, const RayOrigin& at) {
    RayOrigin start = other;
    start.position = at.position;
    return start;
}

bool meet_boundary(const PathSpace& space, Path& path, const SurfaceHit& hit, std::uint32_t medium,
                   const TextureView* view, RandomStream& random) {
    const ReferenceScene& scene = space.scene;
    const bool enters = glm::dot(path.direction, hit.flat) < 0;
    Crossing crossing;
    crossing.beyond = path.stack;
    crossing.far =
        cross_boundary(scene, path.origin, path.direction, hit, path.key, crossing.beyond);
    if (path.stack.top() == crossing.beyond.top()) {
        // A shell inside or overlapping a body of the same medium has no effect.
        path.stack = crossing.beyond;
        return pass_surface(path, crossing.far);
    }
    if (path.stack.empty()) {
        crossing.color = base_color_at(scene.surfaces.scene(), hit, view);
    }
    const float ratio = index_of(scene, crossing.beyond) / index_of(scene, path.stack);
    if (is_matched(ratio)) {
        const RayOrigin before = path.origin;
        pass_boundary(path, crossing);
        path.origin = before;
        return pass_surface(path, crossing.far) && path.beta != glm::vec3(0) &&
               is_wanted(space, path.state);
    }
    const float side = enters ? 1.0f : -1.0f;
    crossing.normal = side * shading_normal(scene.surfaces.scene(), hit);
    crossing.ratio = ratio;
    crossing.flat = side * hit.flat;
    crossing.alpha = scene.media[medium].boundary_alpha;
    if (crossing.alpha > 0) {
        crossing.normal = fitting_normal(path.direction, crossing.normal, crossing.flat);
        crossing.near = start_on(crossing.far, leave_surface(hit, crossing.flat));
        return reflect_or_refract(space, path, crossing, random);
    }
    crossing.split =
        split_at_smooth_boundary(path.direction, crossing.normal, crossing.flat, ratio);
    crossing.near = start_on(crossing.far, leave_surface(hit, crossing.split.reflected));
    return reflect_or_refract(space, path, crossing, random);
}

// Adds what a surface that a path has met sends out by itself.
void meet_emission(const PathSpace& space, Path& path, const SurfaceHit& hit,
                   const TextureView* view) {
    const formats::Scene& scene = space.scene.surfaces.scene();
    const formats::Material& material = scene.materials[scene.primitives[hit.primitive].material];
    if (!counts_lamps(space, path.state) || !is_seen_to_glow(material, path.direction, hit.flat))
        return;
    const float weight =
        path.pdf > 0 ? path.pdf / (path.pdf + pdf_triangle(space.scene.lamps, hit, path.vertex))
                     : 1.0f;
    path.radiance += weight * per_squared_index(space.scene, path.stack) * path.beta *
                     emission_of(scene, hit, view);
}

bool meet_surface(const PathSpace& space, Path& path, const SurfaceHit& hit, RandomStream& random) {
    const formats::Scene& scene = space.scene.surfaces.scene();
    const std::uint32_t number = scene.primitives[hit.primitive].material;
    std::optional<TextureView> over;
    if (path.filter && path.filter->arrive(scene, path.direction, hit)) {
        over.emplace(path.filter->view());
    }
    const TextureView* view = over ? &*over : nullptr;
    meet_emission(space, path, hit, view);
    if (const std::uint32_t medium = space.scene.medium_of[number]; medium != formats::kNone) {
        return meet_boundary(space, path, hit, medium, view, random);
    }
    const bool back = glm::dot(path.direction, hit.flat) > 0;
    if (back && !scene.materials[number].double_sided) {
        if (path.state.stage == PathState::Stage::camera) {
            // Culled in pictures; black to other light.
            return pass_surface(path, leave_surface(hit, path.direction));
        }
        return false;
    }
    const float side = back ? -1.0f : 1.0f;
    const OpaquePoint point{leave_surface(hit, side * hit.flat),
                            leave_surface(hit, -side * hit.flat), side * shading_normal(scene, hit),
                            side * hit.flat, opaque_surface_at(scene, hit, view)};
    return reflect_at_surface(space, path, point, random);
}

void reach_sky(const PathSpace& space, Path& path) {
    const bool is_background = path.state.stage == PathState::Stage::camera;
    if (!path.stack.empty() && space.scene.is_closed) {
        // Along an edge or in the plane of a face rounding may miss where a body ends.
        path.stack = {};
        path.state = after_crossing(path.state, true);
    }
    if (!path.stack.empty()) {
        path.lost = true;
    } else if (is_background ? space.options.terms == TermSet::all
                             : counts_sky(space, path.state)) {
        const float weight =
            path.pdf > 0 ? path.pdf / (path.pdf + pdf_light(space.light, path.direction)) : 1.0f;
        path.sky = weight * path.beta;
        path.radiance += path.sky * eval_light(space.light, path.direction);
    }
}

// One flight and the event that ends it. False: the path ends.
bool advance(const PathSpace& space, Path& path, RandomStream& random) {
    const HitScene& surfaces = space.scene.surfaces;
    std::optional<SurfaceHit> hit;
    if (path.stack.empty()) {
        hit = surfaces.closest_hit(path.origin, path.direction, kForever, path.key);
        if (!space.scene.volumes.empty()) {
            const VolumeFlight flight = sample_volume_flight(
                space.scene.volumes, path.origin.position, path.direction,
                hit ? hit->distance : kForever, path.beta, random, counts_glow(space));
            path.radiance += path.beta * flight.emitted;
            path.beta *= flight.weight;
            if (flight.collides) {
                return scatter_in_volume(space, path,
                                         path.origin.position + flight.distance * path.direction,
                                         flight.volume, random);
            }
        }
    } else {
        // Rounding must not move a scattering point beyond the boundary.
        const float margin = surfaces.rounding();
        bool is_near_surface = false;
        const auto find = [&](float reach) -> std::optional<SurfaceHit> {
            if (reach + margin < space.scene.clearance(path.origin.position)) return std::nullopt;
            const auto found =
                surfaces.closest_hit(path.origin, path.direction, reach + margin, path.key);
            is_near_surface = found.has_value();
            return found;
        };
        const ReferenceMedium& medium = space.scene.media[path.stack.top()];
        const Flight flight = medium.field
                                  ? sample_varied_flight(medium, path.origin.position,
                                                         path.direction, path.beta, random, find)
                                  : sample_flight(medium, path.beta, random, find);
        path.beta *= flight.weight;
        hit = flight.surface;
        if (!hit && !std::isinf(flight.distance)) {
            const float distance = std::max(
                path.origin.free, is_near_surface ? flight.distance - margin : flight.distance);
            const glm::vec3 at = path.origin.position + distance * path.direction;
            if (!surfaces.is_in_bounds(at)) {
                path.lost = true;
                return false;
            }
            return scatter(space, path, at, random);
        }
    }
    if (!hit) {
        reach_sky(space, path);
        return false;
    }
    return meet_surface(space, path, *hit, random);
}

// Start of a path that enters a body at a vertex. `inside` is clear of the vertex's triangles, but
// the path may already scatter between the surface and that point, so the flight starts on the
// tangent plane and ignores hits before it passes `inside`.
RayOrigin enter_at(glm::vec3 vertex, glm::vec3 inside, glm::vec3 normal, glm::vec3 direction) {
    constexpr float kGrazing = 0.1f;
    const float depth = glm::dot(vertex - inside, normal);
    const float way = std::max(0.0f, depth) / std::max(kGrazing, -glm::dot(direction, normal));
    return {inside - way * direction, way};
}

// Of a path's rays, where a surface lets some pass by chance.
std::uint32_t draw_key(const PathSpace& space, RandomStream& random) {
    return space.scene.surfaces.hierarchy().has_chances()
               ? static_cast<std::uint32_t>(random.next() * 0x1p24f)
               : 0;
}

bool is_finite(glm::vec3 v) {
    return std::isfinite(v.x + v.y + v.z);
}

// The path begins again where it entered the body that it is in, with the throughput it has.
void enter_again(Path& path, const Path& entry) {
    const glm::vec3 beta = path.beta, radiance = path.radiance;
    path = entry;
    path.beta = beta;
    path.radiance = radiance;
}

// What leaves a body through a hole counts as the mean of the rest: with w the mean share that is
// lost, entering again makes 1 + w + w^2 + ... = 1 / (1 - w) of what reaches the surface.
PathSample finish(const PathSpace& space, Path& path, RandomStream& random) {
    constexpr std::uint32_t kMostEntries = 8;  // of bodies that are mostly hole
    Path entry = path;
    std::uint32_t entries = 0;
    while (true) {
        const bool was_outside = path.stack.empty();
        if (advance(space, path, random)) {
            if (was_outside && !path.stack.empty()) {
                entry = path;
            }
        } else if (path.lost && entries < kMostEntries && is_finite(path.beta)) {
            enter_again(path, entry);
            ++entries;
        } else {
            break;
        }
    }
    if (!is_finite(path.radiance)) {
        return {.lost = true, .events = path.events};
    }
    return {path.radiance, path.lost || entries > 0, path.events, path.sky, path.direction};
}

}  // namespace

PathSample trace_ray(const PathSpace& space, glm::vec3 origin, glm::vec3 direction,
                     RandomStream& random, const SurroundingMedia& around,
                     const RaySpread& spread) {
    Path path;
    if (space.filtering != nullptr) {
        path.filter.emplace(*space.filtering, spread.dD_dx, spread.dD_dy);
    }
    path.stack = around;
    if (!around.empty()) {
        path.state.stage = PathState::Stage::inside;
    }
    path.key = draw_key(space, random);
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
    // An opaque surface shows its front from anywhere, as its row does.
    if (normal == glm::vec3(0) || (!opaque && !(glm::dot(normal, receiver.to_eye) > 0))) {
        return {};
    }
    Path path;
    path.key = draw_key(space, random);
    path.direction = -receiver.to_eye;
    path.stack = receiver.around;
    if (counts_lamps(space) && is_emissive(material)) {
        path.radiance += per_squared_index(space.scene, path.stack) *
                         emission_of_vertex(scene, receiver.primitive, receiver.vertex);
    }
    bool walks = false;
    if (opaque) {
        OpaquePoint point{outside, inside, normal, glm::vec3(0),
                          opaque_surface_at_vertex(scene, receiver.primitive, receiver.vertex)};
        point.surface.base_color = receiver.base_color;
        point.is_own_mirror = !space.options.own_mirror;
        walks = reflect_at_surface(space, path, point, random);
    } else {
        Crossing crossing;
        crossing.beyond = receiver.within;
        if (crossing.beyond.empty()) {
            crossing.beyond.enter(receiver.medium);
        }
        const float ratio =
            index_of(space.scene, crossing.beyond) / index_of(space.scene, path.stack);
        crossing.split = split_at_boundary(path.direction, normal, ratio);
        crossing.alpha = space.scene.media[receiver.medium].boundary_alpha;
        crossing.normal = normal;
        crossing.ratio = ratio;
        crossing.near = outside;
        crossing.far = inside;
        crossing.color = receiver.base_color;
        crossing.is_own_mirror = !space.options.own_mirror;
        const bool matched = is_matched(ratio);
        if (matched || (crossing.is_own_mirror && !(crossing.alpha > 0))) {
            path.beta *= matched ? 1 : 1 - crossing.split.reflectance;
            path.events += matched ? 0 : 1;
            path.direction = matched ? path.direction : crossing.split.transmitted;
            pass_boundary(path, crossing);
            walks = path.beta != glm::vec3(0) && is_wanted(space, path.state);
        } else {
            walks = reflect_or_refract(space, path, crossing, random);
        }
        if (glm::dot(path.direction, normal) < 0) {
            path.origin = enter_at(receiver.position, inside.position, normal, path.direction);
        }
    }
    return walks ? finish(space, path, random)
                 : PathSample{.radiance = path.radiance, .events = path.events};
}

}  // namespace opaline::bake
