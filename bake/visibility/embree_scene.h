#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/scene.h"

struct RTCDeviceTy;  // Embree's handles: its header is for those who trace
struct RTCSceneTy;

namespace opaline::bake {

/// All triangles of a scene in an Embree device of their own, in the scene's frame, so that no
/// coordinate is rounded again. Immutable once built; any thread may trace.
class EmbreeScene {
  public:
    /// Builds the hierarchy (of a scene without triangles too: the open sky) with `threads` threads
    /// (0: all). Errors: resource.
    static formats::Result<EmbreeScene> build(const formats::Scene& scene, unsigned threads);

    EmbreeScene(EmbreeScene&& other) noexcept;
    EmbreeScene& operator=(EmbreeScene&& other) noexcept;
    ~EmbreeScene();

    RTCSceneTy* handle() const { return scene_; }

    /// The triangles of one primitive.
    struct Geometry {
        std::uint32_t primitive, material;  ///< numbers of formats::Scene
        bool double_sided;
        float error_bound;  ///< [m] on how far a hit on one of them may lie from where it should
    };
    /// By Embree's number of a hit.
    const Geometry& geometry(std::uint32_t id) const { return geometries_[id]; }

    std::uint64_t triangles() const { return triangles_; }

    /// Box around all vertices [m]; low > high where there are none.
    glm::vec3 low() const { return low_; }
    glm::vec3 high() const { return high_; }

    /// Embree's version and the instruction set it is pinned to: hit distances differ between
    /// instruction sets, so both belong into the provenance.
    static std::string description();

  private:
    EmbreeScene() = default;

    RTCDeviceTy* device_ = nullptr;
    RTCSceneTy* scene_ = nullptr;
    std::vector<Geometry> geometries_;
    std::uint64_t triangles_ = 0;
    glm::vec3 low_{std::numeric_limits<float>::max()};
    glm::vec3 high_{std::numeric_limits<float>::lowest()};
};

}  // namespace opaline::bake
