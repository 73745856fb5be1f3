#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/plan/effect.h"
#include "bake/scene/medium_field.h"
#include "bake/trace/bodies_at.h"
#include "bake/trace/cross_bodies.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A medium through which light goes straight.
struct StraightMedium {
    float eta = 1;
    std::array<float, 3> sigma_t{};      ///< [1/m]; scattering included: it takes light away too
    std::optional<MediumField> field{};  ///< where its density varies: scales sigma_t
};

/// A body through which light goes straight, and others that it goes on into.
struct StraightBody {
    const formats::Scene* scene = nullptr;
    const RayScene* rays = nullptr;  ///< all triangles
    const RayScene* sky = nullptr;   ///< what stands before the light that leaves the bodies
    std::uint32_t material = 0;
    double eta = 1;
    std::uint32_t bands = 3;  ///< 1: the first stands for all
    /// Of each material, its place in order_media; kNoPlace: views end there.
    std::vector<std::uint16_t> place_of;
    std::vector<StraightMedium> media;  ///< by place
    std::optional<BodiesAt> bodies{};   ///< where others may be around a point of its surface
    bool meets = false;                 ///< surfaces of these bodies touch or overlap
    bool ends_at_others = false;        ///< rows of walks hold what crosses others
};

/// Of the material's bodies. `inner`: materials of others that light inside may come to. `meets`:
/// of StraightBody. All must outlive the result.
StraightBody make_straight_body(const formats::Scene& scene, const RayScene& rays,
                                std::uint32_t material, std::span<const std::uint32_t> inner,
                                bool meets);
/// The same of an effect's material.
StraightBody make_straight_body(const EffectInputs& inputs);

/// Where views through a body start.
struct StraightStart {
    glm::vec3 position{0};  ///< [m], just inside
    MediumStack bodies;     ///< around the point; not empty
    glm::vec3 vertex{0};    ///< [m], on the boundary: corner of the triangles around it
};

/// The start of a receiver's views. `rays` counts up.
StraightStart make_straight_start(const StraightBody& body, const BodyPoint& point,
                                  std::uint64_t& rays);

/// Light that a view finds: what arrives from `direction` is seen with `weight`.
struct StraightExit {
    std::uint32_t view = 0;
    glm::vec3 direction{0};         ///< unit, outside, away from the body
    std::array<float, 3> weight{};  ///< per band: attenuated, transmitted, of radiance over eta^2
    glm::vec3 origin{0};            ///< [m], clear of the boundary
    float eta = 1;                  ///< where the light comes from
    bool is_opaque = false;         ///< of an end inside: it is no medium
};

/// What a set of views finds, not in their order.
struct StraightLight {
    std::vector<StraightExit> exits;    ///< into the sky
    std::vector<StraightExit> blocked;  ///< toward something that stands before the sky
    std::vector<StraightExit> inside;   ///< at what views do not cross, from before it
    /// Views that leave at once through a triangle of their own vertex: a smooth surface has none
    /// of these.
    std::vector<std::uint32_t> past;
};

/// Weights below are left out: with them at most that much of the light of each way of a view.
inline constexpr float kLeastStraightWeight = 0x1p-12f;

/// Between two media both shares go on, each a way of its own, where the lesser is at least that
/// much of a view's light: so a view has at most 32 ways for each band.
inline constexpr float kLeastParted = 0x1p-5f;

/// Follows views straight through a body and those that it meets, backwards from the eye
/// (README.md, "The paths"): where they arrive at the outside the transmitted share is an exit, and
/// the reflected share goes on; between two media both go on. `seen`: unit directions inside, away
/// from the body, toward the eye. Light through a hole is none. Appends to `found`. Returns the
/// rays traced. Any thread.
std::uint64_t follow_straight(const StraightBody& body, const StraightStart& start,
                              std::span<const glm::vec3> seen, StraightLight& found);

}  // namespace opaline::bake
