#include "bake/effects/multiple/walks/find_hit.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opaline::bake {

bool find_hit(const WalkSpace& space, glm::vec3 origin, glm::vec3 direction, float reach,
              WalkHit& hit) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.org_x = origin.x, ray.ray.org_y = origin.y, ray.ray.org_z = origin.z;
    ray.ray.dir_x = direction.x, ray.ray.dir_y = direction.y, ray.ray.dir_z = direction.z;
    ray.ray.tfar = reach;
    ray.ray.mask = 0xffffffffu;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(space.triangles->handle(), &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return false;
    }
    const EmbreeScene::Geometry& geometry = space.triangles->geometry(ray.hit.geomID);
    const glm::vec3 normal(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
    const float length = glm::length(normal);
    hit.flat = length > 0 ? normal / length : direction;
    hit.primitive = geometry.primitive;
    hit.first_index = 3 * ray.hit.primID;
    hit.u = ray.hit.u, hit.v = ray.hit.v;
    hit.is_own = geometry.material == space.material;
    hit.medium = space.medium_of[geometry.material];
    const formats::Primitive& p = space.scene->primitives[hit.primitive];
    const std::uint32_t* corner = &p.index[hit.first_index];
    const glm::vec3 a = (1 - hit.u - hit.v) * p.position[corner[0]];
    const glm::vec3 b = hit.u * p.position[corner[1]], c = hit.v * p.position[corner[2]];
    hit.position = a + b + c;
    // Rounding of three products and two sums; and, for planes on which it is exact, some distance
    // all the same, so that a ray that leaves the triangle does not meet it again.
    constexpr float kRounding = std::numeric_limits<float>::epsilon();
    const glm::vec3 size = glm::abs(a) + glm::abs(b) + glm::abs(c);
    hit.error = kRounding * std::max(8 * glm::dot(glm::abs(hit.flat), size),
                                     std::max({size.x, size.y, size.z}));
    return true;
}

bool sees(const WalkSpace& space, glm::vec3 from, glm::vec3 to) {
    constexpr float kBefore = 0.999f;
    const glm::vec3 way = to - from;
    const float length = glm::length(way);
    if (!(length > 0)) {
        return true;
    }
    const glm::vec3 direction = way / length;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{};
    ray.org_x = from.x, ray.org_y = from.y, ray.org_z = from.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tfar = kBefore * length;
    ray.mask = 0xffffffffu;
    rtcOccluded1(space.triangles->handle(), &context, &ray);
    return ray.tfar >= 0;  // -inf where something was hit
}

glm::vec3 smooth_normal(const WalkSpace& space, const WalkHit& hit) {
    const formats::Primitive& p = space.scene->primitives[hit.primitive];
    const std::uint32_t* corner = &p.index[hit.first_index];
    const glm::vec3 sum = (1 - hit.u - hit.v) * p.normal[corner[0]] + hit.u * p.normal[corner[1]] +
                          hit.v * p.normal[corner[2]];
    const float length = glm::length(sum);
    return length > 0 && glm::dot(sum, hit.flat) > 0 ? sum / length : hit.flat;
}

glm::vec3 inner_boundary_normal(const WalkSpace& space, const WalkHit& hit, glm::vec3 direction) {
    const glm::vec3 normal = smooth_normal(space, hit);
    const glm::vec3 reflected = direction - 2 * glm::dot(direction, normal) * normal;
    return glm::dot(direction, normal) <= 0 || glm::dot(reflected, hit.flat) >= 0 ? hit.flat
                                                                                  : normal;
}

}  // namespace opaline::bake
