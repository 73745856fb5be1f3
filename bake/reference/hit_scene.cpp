#include "bake/reference/hit_scene.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::Primitive;
using formats::Scene;

struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
};

Box box_of(const Scene& scene) {
    Box box;
    for (const Primitive& p : scene.primitives) {
        for (const glm::vec3& v : p.position) {
            box.low = glm::min(box.low, v);
            box.high = glm::max(box.high, v);
        }
    }
    return box.low.x <= box.high.x ? box : Box{glm::vec3(0), glm::vec3(0)};
}

RTCRay make_ray(const RayOrigin& origin, glm::vec3 direction, float nearest, float reach) {
    RTCRay ray{};
    ray.org_x = origin.position.x, ray.org_y = origin.position.y, ray.org_z = origin.position.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tnear = nearest;
    ray.tfar = reach;
    ray.mask = 0xffffffffu;
    return ray;
}

glm::vec3 unit_or(glm::vec3 v, glm::vec3 otherwise) {
    const float length = glm::length(v);
    return length > 0 ? v / length : otherwise;
}

}  // namespace

struct HitScene::Handles {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<std::uint32_t> primitive;  // by Embree geometry id

    Handles() = default;
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

HitScene::HitScene() : handles_(std::make_unique<Handles>()) {}
HitScene::HitScene(HitScene&&) noexcept = default;
HitScene& HitScene::operator=(HitScene&&) noexcept = default;
HitScene::~HitScene() = default;

formats::Result<HitScene> HitScene::build(const Scene& scene, unsigned threads) {
    HitScene result;
    result.scene_ = &scene;
    const Box box = box_of(scene);
    result.centre_ = 0.5f * box.low + 0.5f * box.high;
    const glm::vec3 size = box.high - result.centre_;
    // A product, a sum, and the hit's distance: a few half ulps.
    result.rounding_ =
        4 * std::numeric_limits<float>::epsilon() * std::max({size.x, size.y, size.z});
    // Rounded outward.
    result.half_size_ = 1.00001f * glm::max(box.high - result.centre_, result.centre_ - box.low) +
                        std::numeric_limits<float>::min();
    Handles& h = *result.handles_;
    const auto failed = [&] {
        return formats::make_error(ErrorKind::resource, scene.source, "ray tracer",
                                   "the ray hierarchy cannot be built",
                                   "free some memory, or use a smaller scene");
    };
    // A fixed instruction set, because distances differ between instruction sets in their last
    // bits.
    h.device = rtcNewDevice("isa=avx2");
    if (h.device == nullptr) {
        return failed();
    }
    h.scene = rtcNewScene(h.device);
    rtcSetSceneFlags(h.scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(h.scene, RTC_BUILD_QUALITY_HIGH);
    for (std::uint32_t number = 0; number < scene.primitives.size(); ++number) {
        const Primitive& p = scene.primitives[number];
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
            return failed();
        }
        for (const glm::vec3& position : p.position) {
            for (int axis = 0; axis < 3; ++axis) {
                *vertex++ = position[axis] - result.centre_[axis];
            }
        }
        std::copy(p.index.begin(), p.index.end(), index);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(h.scene, geometry);  // ids count up from 0
        h.primitive.push_back(number);
        rtcReleaseGeometry(geometry);
    }
    tbb::task_arena arena(threads != 0 ? static_cast<int>(threads) : tbb::task_arena::automatic);
    arena.execute([&h] { rtcCommitScene(h.scene); });
    if (rtcGetDeviceError(h.device) != RTC_ERROR_NONE) {
        return failed();
    }
    return result;
}

std::optional<SurfaceHit> HitScene::closest_hit(const RayOrigin& origin, glm::vec3 direction,
                                                float reach) const {
    float nearest = 0;
    while (true) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit ray{make_ray(origin, direction, nearest, reach), {}};
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(handles_->scene, &context, &ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
            return std::nullopt;
        }
        SurfaceHit hit;
        hit.primitive = handles_->primitive[ray.hit.geomID];
        hit.triangle = ray.hit.primID;
        if (hit.primitive == origin.primitive && hit.triangle == origin.triangle) {
            // A straight line leaves a plane once; rounding caused this second hit. Continue behind
            // it.
            nearest = std::nextafter(ray.ray.tfar, std::numeric_limits<float>::infinity());
            continue;
        }
        hit.distance = ray.ray.tfar;
        hit.u = ray.hit.u, hit.v = ray.hit.v;
        const Primitive& p = scene_->primitives[hit.primitive];
        const std::uint32_t* corner = &p.index[3 * std::size_t{hit.triangle}];
        const float w = 1 - hit.u - hit.v;
        const glm::vec3 a = w * (p.position[corner[0]] - centre_);
        const glm::vec3 b = hit.u * (p.position[corner[1]] - centre_);
        const glm::vec3 c = hit.v * (p.position[corner[2]] - centre_);
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
        hit.error =
            kRoundings * glm::dot(glm::abs(hit.flat), glm::abs(a) + glm::abs(b) + glm::abs(c));
        return hit;
    }
}

bool HitScene::is_blocked(const RayOrigin& origin, glm::vec3 direction) const {
    if (origin.triangle != formats::kNone) {
        return closest_hit(origin, direction, std::numeric_limits<float>::infinity()).has_value();
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = make_ray(origin, direction, 0, std::numeric_limits<float>::infinity());
    rtcOccluded1(handles_->scene, &context, &ray);
    return ray.tfar < 0;
}

RayOrigin leave_surface(const SurfaceHit& hit, glm::vec3 direction) {
    const float side = glm::dot(direction, hit.flat) < 0 ? -hit.error : hit.error;
    return {hit.position + side * hit.flat, hit.primitive, hit.triangle};
}

}  // namespace opaline::bake
