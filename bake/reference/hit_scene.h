#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "bake/transport/embree_scene.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

struct TextureView;  // scene/texture_pyramid.h

/// A hit of a ray on a triangle.
struct SurfaceHit {
    float distance = 0;  ///< [m] along the ray
    glm::vec3 position{0};
    glm::vec3 flat{0};    ///< unit normal of the triangle, by its winding: outward
    glm::vec3 smooth{0};  ///< unit interpolated normal, within the hemisphere of `flat`
    float error = 0;      ///< bound [m] on the distance of `position` from the triangle
    float u = 0, v = 0;   ///< weights of the second and third corner
    std::uint32_t primitive = 0, triangle = 0;  ///< numbers of formats::Scene
};

/// Start of a ray: on a triangle that it cannot hit again, or in free space.
struct RayOrigin {
    glm::vec3 position{0};
    std::uint32_t primitive = formats::kNone, triangle = formats::kNone;
    float free = 0;  ///< [m] >= 0: hits nearer than this are ignored
};

/// All triangles of a scene, for closest hits of single rays in the scene's frame. Immutable;
/// any thread may trace.
class HitScene {
  public:
    /// `scene` must outlive the result. Errors: resource.
    static formats::Result<HitScene> build(const formats::Scene& scene, unsigned threads);

    /// The first triangle within `reach` [m], front or back. `direction` is unit. `key`: of the
    /// choices where a material covers a share of its surface (bake/scene/coverage.h).
    std::optional<SurfaceHit> closest_hit(const RayOrigin& origin, glm::vec3 direction, float reach,
                                          std::uint32_t key = 0) const;
    /// True if there is any.
    bool is_blocked(const RayOrigin& origin, glm::vec3 direction, std::uint32_t key = 0) const;

    const formats::Scene& scene() const { return *scene_; }
    const EmbreeScene& hierarchy() const { return triangles_; }
    /// Bound [m] on the position error of a point computed along a ray.
    float rounding() const { return rounding_; }
    /// Of the box around everything [m]: its middle, and a little more than half of it each way.
    glm::vec3 centre() const { return centre_; }
    glm::vec3 half_size() const { return half_size_; }
    /// False outside the bounding box, where a point is in no body.
    bool is_in_bounds(glm::vec3 position) const {
        return glm::all(glm::lessThanEqual(glm::abs(position - centre_), half_size_));
    }

  private:
    HitScene(const formats::Scene& scene, EmbreeScene triangles);
    EmbreeScene triangles_;
    const formats::Scene* scene_ = nullptr;
    glm::vec3 centre_{0}, half_size_{0};
    float rounding_ = 0;
};

/// Start of a ray that leaves a hit point in `direction`: moved off the triangle to the side that
/// the direction points to, by the hit's error bound.
RayOrigin leave_surface(const SurfaceHit& hit, glm::vec3 direction);

/// Base colour: factor, vertex colours, veins and texture (in linear light). `view`: the footprint
/// that textures are looked up over; null: at the point, bilinear.
glm::vec3 base_color_at(const formats::Scene& scene, const SurfaceHit& hit,
                        const TextureView* view = nullptr);
/// Base colour of a vertex.
glm::vec3 base_color_at_vertex(const formats::Scene& scene, std::uint32_t primitive,
                               std::uint32_t vertex);

}  // namespace opaline::bake
