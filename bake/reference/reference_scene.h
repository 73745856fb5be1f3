#pragma once

#include <cstdint>
#include <vector>

#include "bake/reference/hit_scene.h"
#include "bake/reference/lamp_sampler.h"
#include "bake/reference/volume_flight.h"
#include "bake/reference/volume_space.h"
#include "bake/trace/clearance_grid.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A scene prepared for the reference.
struct ReferenceScene {
    HitScene surfaces;
    std::vector<ReferenceMedium> media;    ///< of materials that have one, as order_media says
    std::vector<std::uint32_t> medium_of;  ///< by material; formats::kNone: opaque
    bool has_matched_boundary = false;     ///< some medium has an index of 1
    bool is_closed = true;                 ///< no medium's surface ends at an edge
    VolumeSpace volumes;                   ///< they fill the space outside of bodies
    ClearanceGrid clearance;               ///< trivial if there are no media
    LampSampler lamps;                     ///< the scene's own light
};

/// `scene` must outlive the result. Errors: resource.
formats::Result<ReferenceScene> make_reference_scene(const formats::Scene& scene, unsigned threads);

/// Of a medium that scatters, bakes and published measurements know a smooth boundary; a clear one
/// has the roughness of its material.
inline bool has_rough_boundary(const formats::Medium& medium) {
    const formats::Rgb s = medium.sigma_s;
    return s.r == 0 && s.g == 0 && s.b == 0 && medium.roughness > 0;
}

/// Two indices of refraction between which light neither bends nor is reflected.
inline bool is_matched(float ratio) {
    return ratio > 1 - 1e-5f && ratio < 1 + 1e-5f;
}

/// The bodies around a point. Where several overlap, the one of the last medium fills the space:
/// media are numbered in that order (scene/nested_media.h).
struct SurroundingMedia {
    static constexpr std::uint32_t kCapacity = 8;  ///< of different media
    struct Bodies {
        std::uint32_t medium = 0;  ///< index into ReferenceScene::media
        std::uint32_t count = 0;
    };
    Bodies bodies[kCapacity] = {};  ///< ascending by medium
    std::uint32_t size = 0;

    bool empty() const { return size == 0; }
    std::uint32_t top() const { return size > 0 ? bodies[size - 1].medium : formats::kNone; }
    bool contains(std::uint32_t m) const;
    /// Where there is no room the medium that gives way to all others is forgotten.
    void enter(std::uint32_t m);
    /// False, and no effect, if no body of the medium is there (an open or flipped body).
    bool leave(std::uint32_t m);
};

/// A straight line passes a boundary at `hit`, and those that lie on it. `stack` becomes that
/// beyond. Where several lie there, or the line meets an edge, or it leaves a body that it was not
/// in, the bodies beyond are counted anew, in the middle of the way to the next surface. Returns
/// the start of a line there.
RayOrigin cross_boundary(const ReferenceScene& scene, const RayOrigin& origin, glm::vec3 direction,
                         const SurfaceHit& hit, std::uint32_t key, SurroundingMedia& stack);

/// The bodies around a point: a line from the point leaves them more often than it enters. Three
/// directions within 60 degrees of `up` vote, because a body may have holes.
SurroundingMedia surrounding_media(const ReferenceScene& scene, glm::vec3 point, glm::vec3 up);

}  // namespace opaline::bake
