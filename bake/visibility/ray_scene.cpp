#include "bake/visibility/ray_scene.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <limits>

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

glm::vec3 scene_centre(const Scene& scene) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const Primitive& p : scene.primitives) {
        for (const glm::vec3& v : p.position) {
            low = glm::min(low, v);
            high = glm::max(high, v);
        }
    }
    return low.x <= high.x ? 0.5f * low + 0.5f * high : glm::vec3(0);
}

}  // namespace

struct RayScene::Handles {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RTCIntersectContext coherent{};

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
    rays.centre_ = scene_centre(scene);
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
        rtcAttachGeometry(h.scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    // In an arena of its own: Embree's `threads` setting would limit TBB in the whole process.
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

std::string RayScene::description() {
    return std::string("Embree ") + RTC_VERSION_STRING + ", isa=" + kInstructionSet + ", robust";
}

}  // namespace opaline::bake
