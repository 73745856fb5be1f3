#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "bake/trace/embree_scene.h"
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

/// Start of a ray: on triangles that it cannot hit again, or in free space.
struct RayOrigin {
    struct Triangle {
        std::uint32_t primitive = formats::kNone, number = formats::kNone;
        bool operator==(const Triangle&) const = default;
    };

    glm::vec3 position{0};
    float free = 0;                      ///< [m] >= 0: hits nearer than this are ignored
    std::array<Triangle, 8> triangle{};  ///< the first is the last one met
    std::uint32_t triangles = 0;         ///< how many of these are set

    bool is_on(const Triangle& other) const {
        return std::find(triangle.begin(), triangle.begin() + triangles, other) !=
               triangle.begin() + triangles;
    }
    /// The oldest is forgotten where there is no room.
    void add(const Triangle& met) {
        std::copy_backward(triangle.begin(), triangle.end() - 1, triangle.end());
        triangle[0] = met;
        triangles = std::min(triangles + 1, static_cast<std::uint32_t>(triangle.size()));
    }
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
    /// Calls visit(hit) for what a ray meets at `hit`: that, and every other triangle in the same
    /// place but for rounding, such as the faces of bodies that lie on one another, which a start
    /// beyond the first would miss. Of the triangles of one primitive that meet at an edge, one.
    /// Returns the start of a ray that leaves them all in `direction`.
    template <class Visit>
    RayOrigin cross(const RayOrigin& origin, glm::vec3 direction, const SurfaceHit& hit,
                    std::uint32_t key, Visit&& visit) const;
    /// All triangles within `reach` [m], in no order; of each hit, which and where on it, distance
    /// and `flat` alone are set.
    std::vector<SurfaceHit> all_hits(const RayOrigin& origin, glm::vec3 direction, float reach,
                                     std::uint32_t key) const;
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
/// Of a straight line from `before` that goes on at `next`: it meets no triangle twice, whatever
/// rounding makes of its points. So it moves on, but where more triangles than an origin has room
/// for meet: whoever follows a line counts steps, at most kMostSteps.
RayOrigin go_straight_on(const RayOrigin& before, RayOrigin next);
inline constexpr std::uint32_t kMostSteps = 10000;

template <class Visit>
RayOrigin HitScene::cross(const RayOrigin& origin, glm::vec3 direction, const SurfaceHit& hit,
                          std::uint32_t key, Visit&& visit) const {
    constexpr float kLeastCosine = 0.1f, kAtEdge = 1e-5f;
    RayOrigin beyond = leave_surface(hit, direction);
    RayOrigin here = go_straight_on(origin, beyond);
    here.position = origin.position;
    here.free = std::max(origin.free, std::nextafter(hit.distance, 0.0f));
    const float cosine = std::max(kLeastCosine, std::abs(glm::dot(direction, hit.flat)));
    const float end = hit.distance + rounding_ + 2 * hit.error / cosine;
    visit(hit);
    if (!closest_hit(here, direction, end, key)) return beyond;
    for (const SurfaceHit& other : all_hits(here, direction, end, key)) {
        beyond.add({other.primitive, other.triangle});
        const bool is_at_edge = std::min({other.u, other.v, 1 - other.u - other.v}) < kAtEdge;
        if (other.primitive != hit.primitive || !is_at_edge) {
            visit(other);
        }
    }
    beyond.position = origin.position + end * direction;  // of however many
    return beyond;
}

/// Base colour: factor, vertex colours, veins and texture (in linear light). `view`: the footprint
/// that textures are looked up over; null: at the point, bilinear.
glm::vec3 base_color_at(const formats::Scene& scene, const SurfaceHit& hit,
                        const TextureView* view = nullptr);
/// Base colour of a vertex.
glm::vec3 base_color_at_vertex(const formats::Scene& scene, std::uint32_t primitive,
                               std::uint32_t vertex);

}  // namespace opaline::bake
