#include "bake/trace/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>

#include "bake/trace/hit_geometry.h"

namespace opaline::bake {

static_assert(sizeof(RayPacket) == sizeof(RTCRay16) && alignof(RayPacket) == alignof(RTCRay16));
static_assert(offsetof(RayPacket, dir_x) == offsetof(RTCRay16, dir_x) &&
              offsetof(RayPacket, tfar) == offsetof(RTCRay16, tfar) &&
              offsetof(RayPacket, flags) == offsetof(RTCRay16, flags));

namespace {

// Embree's coherent flag is not set: it is no faster here, and on scanned meshes it reports other
// triangles than rtcIntersect1. Without it, packets and single rays agree.
RTCRayHit16 intersect(RTCScene triangles, const LaneMask& lanes, const RayPacket& packet) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit16 ray;
    std::memcpy(&ray.ray, &packet, sizeof packet);
    std::fill(std::begin(ray.hit.geomID), std::end(ray.hit.geomID), RTC_INVALID_GEOMETRY_ID);
    rtcIntersect16(lanes.data(), triangles, &context, &ray);
    return ray;
}

}  // namespace

formats::Result<RayScene> RayScene::build(const formats::Scene& scene, unsigned threads) {
    auto triangles = EmbreeScene::build(scene, threads, true);
    if (!triangles) return std::move(triangles).error();
    return RayScene(std::move(*triangles));
}

void RayScene::occluded(const LaneMask& lanes, RayPacket& packet) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded16(lanes.data(), triangles_.handle(), &context,
                  reinterpret_cast<RTCRay16*>(&packet));
}

PacketHits RayScene::closest(const LaneMask& lanes, const RayPacket& packet) const {
    const RTCRayHit16 ray = intersect(triangles_.handle(), lanes, packet);
    PacketHits hits{};
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        if (lanes[i] == 0 || ray.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        const float x = ray.hit.Ng_x[i], y = ray.hit.Ng_y[i], z = ray.hit.Ng_z[i];
        const float along = x * packet.dir_x[i] + y * packet.dir_y[i] + z * packet.dir_z[i];
        const float length = std::sqrt(x * x + y * y + z * z);
        hits.hit[i] = -1;
        hits.distance[i] = ray.ray.tfar[i];
        // A normal that underflows belongs to a triangle without area, which counts as edge-on.
        const float inverse = length > 0 ? 1.0f / length : 0.0f;
        hits.cosine[i] = along * inverse;
        hits.normal_x[i] = x * inverse;
        hits.normal_y[i] = y * inverse;
        hits.normal_z[i] = z * inverse;
        const EmbreeScene::Geometry& met = triangles_.geometry(geometry_of_lane(ray.hit, i));
        hits.error[i] = met.error_bound;
        hits.material[i] = met.material;
        hits.primitive[i] = met.primitive;
        hits.first_index[i] = 3 * ray.hit.primID[i];
        hits.u[i] = ray.hit.u[i];
        hits.v[i] = ray.hit.v[i];
        hits.offset[i] = met.offset;
    }
    return hits;
}

LaneMask RayScene::meets_back_face(const LaneMask& lanes, const RayPacket& packet) const {
    const RTCRayHit16 ray = intersect(triangles_.handle(), lanes, packet);
    LaneMask back{};
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        if (lanes[i] != 0 && ray.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID &&
            triangles_.geometry(geometry_of_lane(ray.hit, i)).hides) {
            const float along = ray.hit.Ng_x[i] * packet.dir_x[i] +
                                ray.hit.Ng_y[i] * packet.dir_y[i] +
                                ray.hit.Ng_z[i] * packet.dir_z[i];
            back[i] = along > 0 ? -1 : 0;
        }
    }
    return back;
}

}  // namespace opaline::bake
