#include "bake/trace/embree_scene.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/copies.h"
#include "bake/scene/coverage.h"

namespace opaline::bake {

/// What a geometry's rays are asked for.
struct PrimitiveHoles {
    std::uint32_t primitive = 0;
    Coverage coverage;
};

namespace {

using formats::ErrorKind;
using formats::Primitive;
using formats::Scene;

// Pinned: the last bits of hit distances differ between instruction sets.
constexpr const char* kInstructionSet = "avx2";

// Of Embree, for each triangle that some rays of a packet meet.
void pass_holes(const RTCFilterFunctionNArguments* arguments) {
    const PrimitiveHoles& holes = *static_cast<const PrimitiveHoles*>(arguments->geometryUserPtr);
    const unsigned n = arguments->N;
    for (unsigned i = 0; i < n; ++i) {
        if (arguments->valid[i] == 0) continue;
        Passage passage{{RTCRayN_org_x(arguments->ray, n, i), RTCRayN_org_y(arguments->ray, n, i),
                         RTCRayN_org_z(arguments->ray, n, i)},
                        {RTCRayN_dir_x(arguments->ray, n, i), RTCRayN_dir_y(arguments->ray, n, i),
                         RTCRayN_dir_z(arguments->ray, n, i)},
                        RTCRayN_id(arguments->ray, n, i),
                        holes.primitive,
                        RTCHitN_primID(arguments->hit, n, i)};
        if (holes.coverage.clear > 0) {
            const glm::vec3 normal(RTCHitN_Ng_x(arguments->hit, n, i),
                                   RTCHitN_Ng_y(arguments->hit, n, i),
                                   RTCHitN_Ng_z(arguments->hit, n, i));
            const float length = glm::length(normal) * glm::length(passage.direction);
            passage.cosine =
                length > 0 ? std::abs(glm::dot(normal, passage.direction)) / length : 0.0f;
        }
        const float u = RTCHitN_u(arguments->hit, n, i), v = RTCHitN_v(arguments->hit, n, i);
        if (!meets_surface(holes.coverage, passage, u, v)) {
            arguments->valid[i] = 0;
        }
    }
}

// Returns false if memory runs out.
bool add_triangles(RTCDevice device, RTCScene scene, const Primitive& p, PrimitiveHoles* holes) {
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
        if (holes != nullptr) {
            rtcSetGeometryUserData(geometry, holes);
            rtcSetGeometryIntersectFilterFunction(geometry, pass_holes);
            rtcSetGeometryOccludedFilterFunction(geometry, pass_holes);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);  // ids count up from 0
    }
    rtcReleaseGeometry(geometry);
    return has_room;
}

// The triangles of `instanced` once more, moved.
void add_instance(RTCDevice device, RTCScene scene, RTCScene instanced, glm::vec3 offset) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, instanced);
    const std::array<float, 12> columns{1, 0, 0, 0, 1, 0, 0, 0, 1, offset.x, offset.y, offset.z};
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

RTCScene new_scene(RTCDevice device, bool filters) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, filters ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
                                    : RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    return scene;
}

bool hides_inside(const formats::Material& material) {
    const bool is_clear = material.medium && material.medium->sigma_s == formats::Rgb{};
    return !material.double_sided && !is_clear;
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
    std::swap(holes_, other.holes_);
    std::swap(has_chances_, other.has_chances_);
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

formats::Result<EmbreeScene> EmbreeScene::build(const Scene& scene, unsigned threads,
                                                bool filters) {
    EmbreeScene built;
    const auto failed = [&](const char* what) {
        return formats::make_error(ErrorKind::resource, scene.source, "ray tracer", what,
                                   "free some memory, or use a smaller scene");
    };
    built.device_ = rtcNewDevice((std::string("isa=") + kInstructionSet).c_str());
    if (built.device_ == nullptr) return failed("the Embree device cannot be made");
    built.scene_ = new_scene(built.device_, filters);
    const std::vector<std::vector<std::uint32_t>> copies = copies_of_primitives(scene);
    // An arena of its own, because Embree's `threads` setting limits TBB in the whole process.
    tbb::task_arena arena(threads != 0 ? static_cast<int>(threads) : tbb::task_arena::automatic);
    CoverageImages images;
    for (std::uint32_t number = 0; number < scene.primitives.size(); ++number) {
        const Primitive& p = scene.primitives[number];
        assert(p.index.size() % 3 == 0 && p.material < scene.materials.size());
        if (p.position.empty()) continue;
        glm::vec3 low = p.position[0], high = low;
        for (const glm::vec3& v : p.position) {
            low = glm::min(low, v);
            high = glm::max(high, v);
        }
        built.extend(low, high);
        if (p.index.empty()) continue;
        PrimitiveHoles* holes = nullptr;
        if (auto coverage = make_coverage(scene, number, images)) {
            built.has_chances_ = built.has_chances_ || coverage->has_chances();
            built.holes_.push_back(
                std::make_unique<PrimitiveHoles>(PrimitiveHoles{number, std::move(*coverage)}));
            holes = built.holes_.back().get();
        }
        const bool is_repeated = !copies[number].empty();
        RTCScene own = is_repeated ? new_scene(built.device_, filters) : built.scene_;
        if (!add_triangles(built.device_, own, p, holes)) {
            if (is_repeated) rtcReleaseScene(own);
            return failed("no memory for its geometry");
        }
        const auto note = [&](glm::vec3 offset) {
            const glm::vec3 far = glm::max(glm::abs(low + offset), glm::abs(high + offset));
            built.geometries_.push_back(
                {number, p.material, hides_inside(scene.materials[p.material]),
                 intersection_error_bound(std::max({far.x, far.y, far.z})), offset});
            built.triangles_ += p.index.size() / 3;
        };
        note(glm::vec3(0));
        if (!is_repeated) continue;
        arena.execute([&] { rtcCommitScene(own); });
        add_instance(built.device_, built.scene_, own, glm::vec3(0));
        for (const std::uint32_t copy : copies[number]) {
            const glm::vec3 offset = scene.primitives[copy].copy.offset;
            add_instance(built.device_, built.scene_, own, offset);
            built.extend(low + offset, high + offset);
            note(offset);
        }
        rtcReleaseScene(own);  // its instances keep it
    }
    arena.execute([&built] { rtcCommitScene(built.scene_); });
    if (rtcGetDeviceError(built.device_) != RTC_ERROR_NONE) {
        return failed("the ray hierarchy cannot be built");
    }
    return built;
}

void EmbreeScene::extend(glm::vec3 low, glm::vec3 high) {
    low_ = glm::min(low_, low);
    high_ = glm::max(high_, high);
}

std::string EmbreeScene::description() {
    return std::string("Embree ") + RTC_VERSION_STRING + ", isa=" + kInstructionSet + ", robust";
}

}  // namespace opaline::bake
