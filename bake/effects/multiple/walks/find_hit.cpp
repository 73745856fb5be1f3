#include "bake/effects/multiple/walks/find_hit.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "bake/trace/hit_geometry.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kRaysTogether = 8;  // rays

// Of Embree: numbers of a geometry and its triangle, weights of corners, normal.
struct FoundTriangle {
    std::uint32_t geometry, triangle;
    float u, v;
    glm::vec3 normal;
};

WalkHit describe_hit(const WalkSpace& space, const FoundTriangle& found, glm::vec3 direction) {
    const EmbreeScene::Geometry& geometry = space.triangles->geometry(found.geometry);
    const float length = glm::length(found.normal);
    WalkHit hit;
    hit.flat = length > 0 ? found.normal / length : direction;
    hit.primitive = geometry.primitive;
    hit.first_index = 3 * found.triangle;
    hit.u = found.u, hit.v = found.v;
    hit.is_own = geometry.material == space.material;
    hit.medium = space.medium_of[geometry.material];
    hit.place = space.place_of[geometry.material];
    const formats::Primitive& p = space.scene->primitives[hit.primitive];
    const std::uint32_t* corner = &p.index[hit.first_index];
    const glm::vec3 a = (1 - hit.u - hit.v) * p.position[corner[0]];
    const glm::vec3 b = hit.u * p.position[corner[1]], c = hit.v * p.position[corner[2]];
    hit.position = a + b + c + geometry.offset;
    // Rounding of three products and two sums; and, for planes on which it is exact, some distance
    // all the same, so that a ray that leaves the triangle does not meet it again.
    constexpr float kRounding = std::numeric_limits<float>::epsilon();
    const glm::vec3 size = glm::abs(a) + glm::abs(b) + glm::abs(c);
    hit.error = kRounding * std::max(8 * glm::dot(glm::abs(hit.flat), size),
                                     std::max({size.x, size.y, size.z}));
    return hit;
}

// Ray `i` of several.
template <class Rays>
void set_ray(Rays& rays, std::size_t i, glm::vec3 origin, glm::vec3 direction, float reach) {
    rays.org_x[i] = origin.x, rays.org_y[i] = origin.y, rays.org_z[i] = origin.z;
    rays.dir_x[i] = direction.x, rays.dir_y[i] = direction.y, rays.dir_z[i] = direction.z;
    rays.tfar[i] = reach;
    rays.mask[i] = 0xffffffffu;
}

struct NearestTriangle {
    const WalkSpace& space;
    glm::vec3 position;
    float square;  // of the distance [m^2]
};

// Squared distance of a triangle from the origin [Ericson2005].
float squared_distance(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const glm::vec3 ab = b - a, ac = c - a;
    const float d1 = -glm::dot(ab, a), d2 = -glm::dot(ac, a);
    if (d1 <= 0 && d2 <= 0) return glm::dot(a, a);
    const float d3 = -glm::dot(ab, b), d4 = -glm::dot(ac, b);
    if (d3 >= 0 && d4 <= d3) return glm::dot(b, b);
    const auto square = [](glm::vec3 v) { return glm::dot(v, v); };
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return square(a + d1 / (d1 - d3) * ab);
    const float d5 = -glm::dot(ab, c), d6 = -glm::dot(ac, c);
    if (d6 >= 0 && d5 <= d6) return glm::dot(c, c);
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return square(a + d2 / (d2 - d6) * ac);
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        return square(b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
    }
    const float scale = 1 / (va + vb + vc);
    return square(a + vb * scale * ab + vc * scale * ac);
}

// Of Embree's point query, for each triangle whose box is near.
bool look_at_triangle(RTCPointQueryFunctionArguments* arguments) {
    NearestTriangle& nearest = *static_cast<NearestTriangle*>(arguments->userPtr);
    const WalkSpace& space = nearest.space;
    const EmbreeScene::Geometry& own = space.triangles->geometry(geometry_of(*arguments));
    const formats::Primitive& p = space.scene->primitives[own.primitive];
    const std::uint32_t* const corner = &p.index[3 * std::size_t{arguments->primID}];
    const glm::vec3 from = nearest.position - own.offset;
    const float square = squared_distance(
        p.position[corner[0]] - from, p.position[corner[1]] - from, p.position[corner[2]] - from);
    if (!(square < nearest.square)) return false;
    nearest.square = square;
    arguments->query->radius = std::sqrt(square);
    return true;
}

}  // namespace

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
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit = describe_hit(space,
                       {geometry_of(ray.hit),
                        ray.hit.primID,
                        ray.hit.u,
                        ray.hit.v,
                        {ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z}},
                       direction);
    return true;
}

std::vector<std::optional<WalkHit>> find_hits(const WalkSpace& space, glm::vec3 origin,
                                              std::span<const glm::vec3> directions) {
    std::vector<std::optional<WalkHit>> hits(directions.size());
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t first = 0; first < directions.size(); first += kRaysTogether) {
        const std::size_t here = std::min(kRaysTogether, directions.size() - first);
        RTCRayHit8 ray{};
        alignas(32) std::array<int, kRaysTogether> valid{};
        for (std::size_t i = 0; i < here; ++i) {
            valid[i] = -1;
            set_ray(ray.ray, i, origin, directions[first + i],
                    std::numeric_limits<float>::infinity());
            ray.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect8(valid.data(), space.triangles->handle(), &context, &ray);
        for (std::size_t i = 0; i < here; ++i) {
            if (ray.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
                hits[first + i] =
                    describe_hit(space,
                                 {geometry_of_lane(ray.hit, i),
                                  ray.hit.primID[i],
                                  ray.hit.u[i],
                                  ray.hit.v[i],
                                  {ray.hit.Ng_x[i], ray.hit.Ng_y[i], ray.hit.Ng_z[i]}},
                                 directions[first + i]);
            }
        }
    }
    return hits;
}

void find_seen(const WalkSpace& space, glm::vec3 from, std::span<const glm::vec3> to,
               std::vector<std::uint8_t>& seen) {
    constexpr float kBefore = 0.999f;
    seen.assign(to.size(), 1);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t first = 0; first < to.size(); first += kRaysTogether) {
        const std::size_t here = std::min(kRaysTogether, to.size() - first);
        RTCRay8 ray{};
        alignas(32) std::array<int, kRaysTogether> valid{};
        for (std::size_t i = 0; i < here; ++i) {
            const glm::vec3 way = to[first + i] - from;
            const float length = glm::length(way);
            valid[i] = length > 0 ? -1 : 0;
            set_ray(ray, i, from, way / length, kBefore * length);
        }
        rtcOccluded8(valid.data(), space.triangles->handle(), &context, &ray);
        for (std::size_t i = 0; i < here; ++i) {
            seen[first + i] = valid[i] == 0 || ray.tfar[i] >= 0 ? 1 : 0;  // -inf: hit
        }
    }
}

bool is_around_vertex(const WalkSpace& space, const WalkHit& hit, glm::vec3 vertex) {
    const formats::Primitive& p = space.scene->primitives[hit.primitive];
    const std::uint32_t* const corner = &p.index[hit.first_index];
    return std::any_of(corner, corner + 3,
                       [&](std::uint32_t v) { return p.position[v] == vertex; });
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

float find_clearance(const WalkSpace& space, glm::vec3 position, float reach) {
    NearestTriangle nearest{space, position, reach * reach};
    RTCPointQuery query{position.x, position.y, position.z, 0, reach};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(space.triangles->handle(), &query, &context, look_at_triangle, &nearest);
    // Of the coordinates, and of a walk's way.
    constexpr float kRounding = 16 * std::numeric_limits<float>::epsilon();
    const glm::vec3 size = glm::abs(position);
    const float distance = std::sqrt(nearest.square);
    return std::max(0.0f,
                    distance * (1 - kRounding) - kRounding * std::max({size.x, size.y, size.z}));
}

}  // namespace opaline::bake
