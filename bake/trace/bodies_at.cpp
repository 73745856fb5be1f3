#include "bake/trace/bodies_at.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <limits>

#include "bake/scene/nested_media.h"
#include "bake/trace/hit_geometry.h"

namespace opaline::bake {

struct BodiesAt::Query {
    RTCIntersectContext embree;
    const BodiesAt& bodies;
    std::vector<Crossed>& crossed;
    std::uint32_t others = 0;

    // Of Embree, for each triangle that the line meets: notes it and goes on.
    static void note(const RTCFilterFunctionNArguments* arguments) {
        if (arguments->valid[0] == 0) return;
        arguments->valid[0] = 0;
        const unsigned n = arguments->N;
        auto& own = *reinterpret_cast<Query*>(arguments->context);
        const std::uint32_t geometry = geometry_of(arguments->hit, n, 0);
        const std::uint32_t triangle = RTCHitN_primID(arguments->hit, n, 0);
        const std::uint32_t place =
            own.bodies.place_[own.bodies.triangles_->geometry(geometry).material];
        if (place == formats::kNone) {
            ++own.others;
            return;
        }
        // The hierarchy may hold a triangle in several parts.
        if (std::ranges::any_of(own.crossed, [&](const Crossed& c) {
                return c.geometry == geometry && c.triangle == triangle;
            })) {
            return;
        }
        const float along =
            RTCHitN_Ng_x(arguments->hit, n, 0) * RTCRayN_dir_x(arguments->ray, n, 0) +
            RTCHitN_Ng_y(arguments->hit, n, 0) * RTCRayN_dir_y(arguments->ray, n, 0) +
            RTCHitN_Ng_z(arguments->hit, n, 0) * RTCRayN_dir_z(arguments->ray, n, 0);
        own.crossed.push_back({geometry, triangle, place, along > 0});
    }
};

BodiesAt::BodiesAt(const formats::Scene& scene, const EmbreeScene& triangles)
    : triangles_(&triangles),
      order_(order_media(scene)),
      place_(scene.materials.size(), formats::kNone) {
    for (std::uint32_t p = 0; p < order_.size(); ++p) {
        place_[order_[p]] = p;
    }
    constexpr float kSteps = 32 * std::numeric_limits<float>::epsilon();
    const glm::vec3 farthest = glm::max(glm::abs(triangles.low()), glm::abs(triangles.high()));
    touch_ =
        triangles.triangles() > 0 ? kSteps * std::max({farthest.x, farthest.y, farthest.z}) : 0;
}

namespace {

RTCRayHit ray_from(glm::vec3 from, glm::vec3 direction, float reach) {
    RTCRayHit ray{};
    ray.ray.org_x = from.x, ray.ray.org_y = from.y, ray.ray.org_z = from.z;
    ray.ray.dir_x = direction.x, ray.ray.dir_y = direction.y, ray.ray.dir_z = direction.z;
    ray.ray.tfar = reach;
    ray.ray.mask = 0xffffffffu;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

}  // namespace

std::uint32_t BodiesAt::collect(glm::vec3 from, glm::vec3 direction, float reach,
                                std::vector<Crossed>& crossed) const {
    crossed.clear();
    Query query{{}, *this, crossed};
    rtcInitIntersectContext(&query.embree);
    query.embree.filter = &Query::note;
    RTCRayHit ray = ray_from(from, direction, reach);
    rtcIntersect1(triangles_->handle(), &query.embree, &ray);
    return query.others;
}

std::optional<float> BodiesAt::find_next(glm::vec3 from, glm::vec3 direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray = ray_from(from, direction, std::numeric_limits<float>::infinity());
    rtcIntersect1(triangles_->handle(), &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return ray.ray.tfar;
}

void BodiesAt::count(glm::vec3 point, std::vector<int>& bodies) const {
    // Along no axis, edge or diagonal of common models.
    static constexpr std::array<glm::vec3, 3> kLines{
        {{0.3617f, 0.4803f, 0.7991f}, {-0.8011f, 0.3589f, -0.4794f}, {0.4823f, -0.7979f, 0.3607f}}};
    std::array<std::vector<int>, kLines.size()> votes;
    std::vector<Crossed> crossed;
    for (std::size_t l = 0; l < kLines.size(); ++l) {
        votes[l].assign(order_.size(), 0);
        collect(point, kLines[l], std::numeric_limits<float>::infinity(), crossed);
        for (const Crossed& c : crossed) {
            votes[l][c.place] += c.leaves ? 1 : -1;
        }
    }
    bodies.resize(order_.size());
    for (std::size_t p = 0; p < bodies.size(); ++p) {
        const int a = votes[0][p], b = votes[1][p], c = votes[2][p];
        bodies[p] = std::max(0, std::max(std::min(a, b), std::min(std::max(a, b), c)));
    }
}

bool BodiesAt::has_faces_on_faces(const formats::Scene& scene,
                                  const std::vector<std::uint8_t>& is_chosen) const {
    std::vector<Crossed> crossed;
    for (const formats::Primitive& p : scene.primitives) {
        if (is_chosen[p.material] == 0) continue;
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            const glm::vec3 a = p.position[p.index[i]], b = p.position[p.index[i + 1]],
                            c = p.position[p.index[i + 2]];
            const glm::vec3 area = glm::cross(b - a, c - a);
            const float length = glm::length(area);
            if (!(length > 0)) continue;
            const glm::vec3 normal = area / length;
            collect((a + b + c) / 3.0f + touch_ * normal, -normal, 2 * touch_, crossed);
            if (std::ranges::count_if(crossed, [&](const Crossed& met) {
                    return is_chosen[order_[met.place]] != 0;
                }) > 1) {
                return true;
            }
        }
    }
    return false;
}

std::uint32_t BodiesAt::material_at(glm::vec3 point) const {
    std::vector<int> bodies;
    count(point, bodies);
    for (std::size_t p = bodies.size(); p-- > 0;) {
        if (bodies[p] > 0) return order_[p];
    }
    return formats::kNone;
}

}  // namespace opaline::bake
