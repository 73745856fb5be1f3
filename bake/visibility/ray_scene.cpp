#include "bake/visibility/ray_scene.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <limits>

#include "bake/receivers/vertex_receivers.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::Primitive;
using formats::Scene;

static_assert(sizeof(RayPacket) == sizeof(RTCRay16) && alignof(RayPacket) == alignof(RTCRay16));
static_assert(offsetof(RayPacket, dir_x) == offsetof(RTCRay16, dir_x) &&
              offsetof(RayPacket, tfar) == offsetof(RTCRay16, tfar) &&
              offsetof(RayPacket, flags) == offsetof(RTCRay16, flags));

constexpr const char* kInstructionSet = "avx2";

struct Extent {
    glm::vec3 centre{0};
    float radius = 0;  // largest coordinate relative to the centre
};

Extent scene_extent(const Scene& scene) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const Primitive& p : scene.primitives) {
        for (const glm::vec3& v : p.position) {
            low = glm::min(low, v);
            high = glm::max(high, v);
        }
    }
    if (low.x > high.x) {
        return {};
    }
    const glm::vec3 half = 0.5f * high - 0.5f * low;
    return {0.5f * low + 0.5f * high, std::max({half.x, half.y, half.z})};
}

}  // namespace

struct RayScene::Handles {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RTCIntersectContext coherent{};
    std::vector<bool> double_sided;       // by Embree geometry id
    std::vector<std::uint32_t> material;  // by Embree geometry id

    Handles() {
        rtcInitIntersectContext(&coherent);
        coherent.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
    ~Handles() {
        if (scene != nullptr) {
            rtcReleaseScene(scene);
        }
        if (device != nullptr) {
            rtcReleaseDevice(device);
        }
    }
};

RayScene::RayScene() : handles_(std::make_unique<Handles>()) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

formats::Result<RayScene> RayScene::build(const Scene& scene, unsigned threads) {
    RayScene rays;
    const Extent extent = scene_extent(scene);
    rays.centre_ = extent.centre;
    rays.error_bound_ = intersection_error_bound(extent.radius);
    Handles& h = *rays.handles_;
    h.device = rtcNewDevice((std::string("isa=") + kInstructionSet).c_str());
    const auto failed = [&](const char* what) {
        return formats::make_error(ErrorKind::resource, scene.source, "ray tracer", what,
                                   "free some memory, or bake a smaller scene");
    };
    if (h.device == nullptr) {
        return failed("the Embree device cannot be made");
    }
    h.scene = rtcNewScene(h.device);
    rtcSetSceneFlags(h.scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(h.scene, RTC_BUILD_QUALITY_HIGH);
    for (const Primitive& p : scene.primitives) {
        if (p.index.empty()) {
            continue;
        }
        RTCGeometry geometry = rtcNewGeometry(h.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertex = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), p.position.size()));
        auto* index = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), p.index.size() / 3));
        if (vertex == nullptr || index == nullptr) {
            rtcReleaseGeometry(geometry);
            return failed("no memory for its geometry");
        }
        for (const glm::vec3& position : p.position) {
            const glm::vec3 relative = position - rays.centre_;
            *vertex++ = relative.x;
            *vertex++ = relative.y;
            *vertex++ = relative.z;
        }
        std::copy(p.index.begin(), p.index.end(), index);
        rays.triangles_ += p.index.size() / 3;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(h.scene, geometry);  // ids count up from 0
        h.double_sided.push_back(scene.materials[p.material].double_sided);
        h.material.push_back(p.material);
        rtcReleaseGeometry(geometry);
    }
    // An arena of its own, because Embree's `threads` setting limits TBB in the whole process.
    tbb::task_arena arena(threads != 0 ? static_cast<int>(threads) : tbb::task_arena::automatic);
    arena.execute([&h] { rtcCommitScene(h.scene); });
    if (rtcGetDeviceError(h.device) != RTC_ERROR_NONE) {
        return failed("the ray hierarchy cannot be built");
    }
    return rays;
}

void RayScene::occluded(const LaneMask& lanes, RayPacket& packet) const {
    RTCIntersectContext context = handles_->coherent;
    rtcOccluded16(lanes.data(), handles_->scene, &context, reinterpret_cast<RTCRay16*>(&packet));
}

PacketHits RayScene::closest(const LaneMask& lanes, const RayPacket& packet) const {
    // Embree's coherent flag is not set: it is no faster here, and on scanned meshes it reports
    // other triangles than rtcIntersect1. Without it, packets and single rays agree.
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit16 ray;
    std::memcpy(&ray.ray, &packet, sizeof packet);
    std::fill(std::begin(ray.hit.geomID), std::end(ray.hit.geomID), RTC_INVALID_GEOMETRY_ID);
    rtcIntersect16(lanes.data(), handles_->scene, &context, &ray);
    PacketHits hits{};
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        if (lanes[i] == 0 || ray.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
            continue;
        }
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
        hits.material[i] = handles_->material[ray.hit.geomID[i]];
    }
    return hits;
}

LaneMask RayScene::meets_back_face(const LaneMask& lanes, const RayPacket& packet) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit16 ray;
    std::memcpy(&ray.ray, &packet, sizeof packet);
    std::fill(std::begin(ray.hit.geomID), std::end(ray.hit.geomID), RTC_INVALID_GEOMETRY_ID);
    rtcIntersect16(lanes.data(), handles_->scene, &context, &ray);
    LaneMask back{};
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        if (lanes[i] != 0 && ray.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID &&
            !handles_->double_sided[ray.hit.geomID[i]]) {
            const float along = ray.hit.Ng_x[i] * packet.dir_x[i] +
                                ray.hit.Ng_y[i] * packet.dir_y[i] +
                                ray.hit.Ng_z[i] * packet.dir_z[i];
            back[i] = along > 0 ? -1 : 0;
        }
    }
    return back;
}

std::string RayScene::description() {
    return std::string("Embree ") + RTC_VERSION_STRING + ", isa=" + kInstructionSet + ", robust";
}

}  // namespace opaline::bake
