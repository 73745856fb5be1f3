#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/scene.h"

struct RTCDeviceTy;  // Embree's handles; callers that trace include Embree's header themselves
struct RTCSceneTy;

namespace opaline::bake {

struct PrimitiveHoles;

/// Owns an Embree device and the hierarchy over all triangles of a scene. Coordinates are those of
/// the scene's frame, without further rounding. Rays pass where a material has holes
/// (bake/scene/coverage.h), whoever traces them; RTCRay::id is the key of their choices. Immutable
/// once built; any thread may trace.
class EmbreeScene {
  public:
    /// Builds the hierarchy with `threads` threads (0: all). A scene without triangles is valid:
    /// the open sky. `filters`: rays may bring a filter of their own (RTCIntersectContext::filter).
    /// Errors: resource.
    static formats::Result<EmbreeScene> build(const formats::Scene& scene, unsigned threads,
                                              bool filters = false);

    EmbreeScene(EmbreeScene&& other) noexcept;
    EmbreeScene& operator=(EmbreeScene&& other) noexcept;
    ~EmbreeScene();

    RTCSceneTy* handle() const { return scene_; }

    /// The triangles of one primitive, or of a copy of one.
    struct Geometry {
        std::uint32_t primitive, material;  ///< numbers of formats::Scene; of a copy's original
        bool hides;         ///< nobody sees what its back faces: not double-sided, nor clear
        float error_bound;  ///< [m], of the computed position of a hit
        glm::vec3 offset;   ///< [m], formats::CopyOf; 0 of what is no copy
    };
    /// `id`: geometry_of a hit (hit_geometry.h).
    const Geometry& geometry(std::uint32_t id) const { return geometries_[id]; }

    std::uint64_t triangles() const { return triangles_; }
    /// Some triangle may let rays pass by chance: choices depend on the key of a ray.
    bool has_chances() const { return has_chances_; }

    /// Box around all vertices [m]; low > high where there are none.
    glm::vec3 low() const { return low_; }
    glm::vec3 high() const { return high_; }

    /// Embree's version and the instruction set it is pinned to, for the provenance: hit distances
    /// differ between instruction sets.
    static std::string description();

  private:
    EmbreeScene() = default;
    void extend(glm::vec3 low, glm::vec3 high);  // the box

    RTCDeviceTy* device_ = nullptr;
    RTCSceneTy* scene_ = nullptr;
    std::vector<Geometry> geometries_;
    std::vector<std::unique_ptr<PrimitiveHoles>> holes_;  ///< Embree keeps their addresses
    bool has_chances_ = false;
    std::uint64_t triangles_ = 0;
    glm::vec3 low_{std::numeric_limits<float>::max()};
    glm::vec3 high_{std::numeric_limits<float>::lowest()};
};

}  // namespace opaline::bake
