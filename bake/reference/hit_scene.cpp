#include "bake/reference/hit_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

RTCRay make_ray(const RayOrigin& origin, glm::vec3 direction, float nearest, float reach,
                std::uint32_t key) {
    RTCRay ray{};
    ray.org_x = origin.position.x, ray.org_y = origin.position.y, ray.org_z = origin.position.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tnear = nearest;
    ray.tfar = reach;
    ray.mask = 0xffffffffu;
    ray.id = key;
    return ray;
}

/// A query that passes the triangles it starts on.
struct LeavingContext {
    RTCIntersectContext embree{};
    const EmbreeScene& triangles;
    const RayOrigin& origin;
};

void pass_own_triangles(const RTCFilterFunctionNArguments* arguments) {
    const auto& own = *reinterpret_cast<const LeavingContext*>(arguments->context);
    const std::uint32_t primitive =
        own.triangles.geometry(RTCHitN_geomID(arguments->hit, arguments->N, 0)).primitive;
    if (own.origin.is_on({primitive, RTCHitN_primID(arguments->hit, arguments->N, 0)})) {
        arguments->valid[0] = 0;
    }
}

/// A query that passes all triangles and remembers them.
struct CollectingContext {
    LeavingContext leaving;
    std::vector<SurfaceHit>& found;
};

void collect_triangle(const RTCFilterFunctionNArguments* arguments) {
    pass_own_triangles(arguments);
    if (arguments->valid[0] == 0) return;
    arguments->valid[0] = 0;
    const auto& own = *reinterpret_cast<const CollectingContext*>(arguments->context);
    const unsigned n = arguments->N;
    SurfaceHit hit;
    hit.primitive = own.leaving.triangles.geometry(RTCHitN_geomID(arguments->hit, n, 0)).primitive;
    hit.triangle = RTCHitN_primID(arguments->hit, n, 0);
    // The hierarchy may hold a triangle in several parts.
    if (std::ranges::any_of(own.found, [&](const SurfaceHit& other) {
            return other.primitive == hit.primitive && other.triangle == hit.triangle;
        })) {
        return;
    }
    hit.distance = RTCRayN_tfar(arguments->ray, n, 0);
    hit.u = RTCHitN_u(arguments->hit, n, 0), hit.v = RTCHitN_v(arguments->hit, n, 0);
    hit.flat = {RTCHitN_Ng_x(arguments->hit, n, 0), RTCHitN_Ng_y(arguments->hit, n, 0),
                RTCHitN_Ng_z(arguments->hit, n, 0)};
    own.found.push_back(hit);
}

glm::vec3 unit_or(glm::vec3 v, glm::vec3 otherwise) {
    const float length = glm::length(v);
    return length > 0 ? v / length : otherwise;
}

}  // namespace

formats::Result<HitScene> HitScene::build(const Scene& scene, unsigned threads) {
    auto triangles = EmbreeScene::build(scene, threads, true);
    if (!triangles) return std::move(triangles).error();
    return HitScene(scene, std::move(*triangles));
}

HitScene::HitScene(const Scene& scene, EmbreeScene triangles)
    : triangles_(std::move(triangles)), scene_(&scene) {
    const glm::vec3 low = triangles_.low(), high = triangles_.high();
    if (low.x > high.x) return;
    centre_ = 0.5f * low + 0.5f * high;
    const glm::vec3 farthest = glm::max(glm::abs(low), glm::abs(high));
    // A product, a sum, and the hit's distance: a few half ulps.
    rounding_ =
        4 * std::numeric_limits<float>::epsilon() * std::max({farthest.x, farthest.y, farthest.z});
    // Rounded outward.
    half_size_ = 1.00001f * glm::max(high - centre_, centre_ - low) +
                 std::numeric_limits<float>::epsilon() * farthest +
                 std::numeric_limits<float>::min();
}

std::optional<SurfaceHit> HitScene::closest_hit(const RayOrigin& origin, glm::vec3 direction,
                                                float reach, std::uint32_t key) const {
    assert(origin.free >= 0);
    if (!(origin.free <= reach)) return std::nullopt;
    LeavingContext context{{}, triangles_, origin};
    rtcInitIntersectContext(&context.embree);
    // A straight line leaves a plane once; rounding causes a second hit.
    context.embree.filter = origin.triangles > 0 ? pass_own_triangles : nullptr;
    // Nor does it meet the triangles beside it where it starts on an edge.
    const float nearest = origin.triangles > 0
                              ? std::max(origin.free, std::numeric_limits<float>::min())
                              : origin.free;
    RTCRayHit ray{make_ray(origin, direction, nearest, reach, key), {}};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(triangles_.handle(), &context.embree, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    SurfaceHit hit;
    hit.primitive = triangles_.geometry(ray.hit.geomID).primitive;
    hit.triangle = ray.hit.primID;
    hit.distance = ray.ray.tfar;
    hit.u = ray.hit.u, hit.v = ray.hit.v;
    const Primitive& p = scene_->primitives[hit.primitive];
    const std::uint32_t* corner = &p.index[3 * std::size_t{hit.triangle}];
    const float w = 1 - hit.u - hit.v;
    const glm::vec3 a = w * p.position[corner[0]];
    const glm::vec3 b = hit.u * p.position[corner[1]];
    const glm::vec3 c = hit.v * p.position[corner[2]];
    hit.position = a + b + c;
    hit.flat = unit_or({ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z}, -direction);
    const glm::vec3 smooth =
        w * p.normal[corner[0]] + hit.u * p.normal[corner[1]] + hit.v * p.normal[corner[2]];
    hit.smooth = unit_or(smooth, hit.flat);
    if (glm::dot(hit.smooth, hit.flat) <= 0) {
        hit.smooth = hit.flat;
    }
    // Rounding of the three products and two sums above, across the plane.
    constexpr float kRoundings = 8 * std::numeric_limits<float>::epsilon();
    hit.error = kRoundings * glm::dot(glm::abs(hit.flat), glm::abs(a) + glm::abs(b) + glm::abs(c));
    return hit;
}

std::vector<SurfaceHit> HitScene::all_hits(const RayOrigin& origin, glm::vec3 direction,
                                           float reach, std::uint32_t key) const {
    std::vector<SurfaceHit> found;
    if (!(origin.free <= reach)) return found;
    CollectingContext context{{{}, triangles_, origin}, found};
    rtcInitIntersectContext(&context.leaving.embree);
    context.leaving.embree.filter = collect_triangle;
    RTCRayHit ray{make_ray(origin, direction, origin.free, reach, key), {}};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(triangles_.handle(), &context.leaving.embree, &ray);
    for (SurfaceHit& hit : found) {
        hit.flat = unit_or(hit.flat, -direction);
    }
    return found;
}

bool HitScene::is_blocked(const RayOrigin& origin, glm::vec3 direction, std::uint32_t key) const {
    if (origin.triangles > 0) {
        return closest_hit(origin, direction, std::numeric_limits<float>::infinity(), key)
            .has_value();
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray =
        make_ray(origin, direction, origin.free, std::numeric_limits<float>::infinity(), key);
    rtcOccluded1(triangles_.handle(), &context, &ray);
    return ray.tfar < 0;
}

RayOrigin leave_surface(const SurfaceHit& hit, glm::vec3 direction) {
    const float side = glm::dot(direction, hit.flat) < 0 ? -hit.error : hit.error;
    RayOrigin origin{hit.position + side * hit.flat};
    origin.add({hit.primitive, hit.triangle});
    return origin;
}

RayOrigin go_straight_on(const RayOrigin& before, RayOrigin next) {
    for (std::uint32_t i = 0; i < before.triangles && next.triangles < next.triangle.size(); ++i) {
        next.triangle[next.triangles++] = before.triangle[i];
    }
    return next;
}

}  // namespace opaline::bake
