#include "bake/transport/embree_scene.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "bake/receivers/vertex_receivers.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::Primitive;
using formats::Scene;

// Pinned: the last bits of hit distances differ between instruction sets.
constexpr const char* kInstructionSet = "avx2";

// Returns false if memory runs out.
bool add_triangles(RTCDevice device, RTCScene scene, const Primitive& p) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               p.position.size()));
    auto* index = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), p.index.size() / 3));
    const bool has_room = vertex != nullptr && index != nullptr;
    if (has_room) {
        for (const glm::vec3& position : p.position) {
            *vertex++ = position.x;
            *vertex++ = position.y;
            *vertex++ = position.z;
        }
        std::copy(p.index.begin(), p.index.end(), index);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);  // ids count up from 0
    }
    rtcReleaseGeometry(geometry);
    return has_room;
}

}  // namespace

EmbreeScene::EmbreeScene(EmbreeScene&& other) noexcept {
    *this = std::move(other);
}

EmbreeScene& EmbreeScene::operator=(EmbreeScene&& other) noexcept {
    // `other` releases what this object held.
    std::swap(device_, other.device_);
    std::swap(scene_, other.scene_);
    std::swap(geometries_, other.geometries_);
    std::swap(triangles_, other.triangles_);
    std::swap(low_, other.low_);
    std::swap(high_, other.high_);
    return *this;
}

EmbreeScene::~EmbreeScene() {
    if (scene_ != nullptr) {
        rtcReleaseScene(scene_);
    }
    if (device_ != nullptr) {
        rtcReleaseDevice(device_);
    }
}

formats::Result<EmbreeScene> EmbreeScene::build(const Scene& scene, unsigned threads) {
    EmbreeScene built;
    const auto failed = [&](const char* what) {
        return formats::make_error(ErrorKind::resource, scene.source, "ray tracer", what,
                                   "free some memory, or use a smaller scene");
    };
    built.device_ = rtcNewDevice((std::string("isa=") + kInstructionSet).c_str());
    if (built.device_ == nullptr) {
        return failed("the Embree device cannot be made");
    }
    built.scene_ = rtcNewScene(built.device_);
    rtcSetSceneFlags(built.scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(built.scene_, RTC_BUILD_QUALITY_HIGH);
    for (std::uint32_t number = 0; number < scene.primitives.size(); ++number) {
        const Primitive& p = scene.primitives[number];
        assert(p.index.size() % 3 == 0 && p.material < scene.materials.size());
        glm::vec3 farthest(0);
        for (const glm::vec3& v : p.position) {
            built.low_ = glm::min(built.low_, v);
            built.high_ = glm::max(built.high_, v);
            farthest = glm::max(farthest, glm::abs(v));
        }
        if (p.index.empty()) {
            continue;
        }
        if (!add_triangles(built.device_, built.scene_, p)) {
            return failed("no memory for its geometry");
        }
        const float magnitude = std::max({farthest.x, farthest.y, farthest.z});
        built.geometries_.push_back({number, p.material, scene.materials[p.material].double_sided,
                                     intersection_error_bound(magnitude)});
        built.triangles_ += p.index.size() / 3;
    }
    // An arena of its own, because Embree's `threads` setting limits TBB in the whole process.
    tbb::task_arena arena(threads != 0 ? static_cast<int>(threads) : tbb::task_arena::automatic);
    arena.execute([&built] { rtcCommitScene(built.scene_); });
    if (rtcGetDeviceError(built.device_) != RTC_ERROR_NONE) {
        return failed("the ray hierarchy cannot be built");
    }
    return built;
}

std::string EmbreeScene::description() {
    return std::string("Embree ") + RTC_VERSION_STRING + ", isa=" + kInstructionSet + ", robust";
}

}  // namespace opaline::bake
