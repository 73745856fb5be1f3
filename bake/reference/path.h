#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "bake/reference/light_sampler.h"
#include "bake/reference/random_stream.h"
#include "bake/reference/reference_scene.h"
#include "bake/reference/terms.h"

namespace opaline::bake {

struct TextureFiltering;  // path_filter.h

/// The paths and light to count.
struct PathOptions {
    TermSet terms = TermSet::all;
    /// Maximum number of scattering events along a path, on surfaces (refraction and mirror
    /// reflection count) or in media. Crossings between equal indices do not count.
    std::uint32_t max_depth = 0xffffffffu;
    /// false: a receiver's own mirror reflection or specular lobe is left out, whatever is seen in
    /// it.
    bool own_mirror = true;
    /// What volumes scatter to the first surface or body of a path counts as what that makes of it,
    /// as if it came from the sky directly; false: as light that met more.
    bool through_volumes = false;
    /// What of `interreflection` counts, by whether it crossed a body unscattered.
    CrossedLight crossed = CrossedLight::counted;
    /// Of `interreflection` counts what a volume scattered last, toward the eye or, with
    /// `through_volumes`, toward the first surface or body: light that surfaces sent to volumes.
    /// Likewise of what lamps that are no volumes sent.
    bool by_volumes = false;
};

/// The surroundings of a path. All outlive the walk.
struct PathSpace {
    const ReferenceScene& scene;
    const LightSampler& light;
    PathOptions options;
    /// Of the paths of `trace_ray`; null: textures are looked up at points.
    const TextureFiltering* filtering = nullptr;
};

/// How the unit direction of an eye's ray changes over its pixel, to the right and up.
struct RaySpread {
    glm::vec3 dD_dx{0}, dD_dy{0};
};

/// A vertex whose radiance is estimated, and the direction from which it is seen.
struct ReferenceReceiver {
    std::uint32_t primitive = 0, vertex = 0;  ///< numbers of formats::Scene
    glm::vec3 position{0};                    ///< [m] of the vertex
    glm::vec3 outside{0}, inside{0};  ///< [m], clear of the vertex's triangles on either side
    glm::vec3 normal{0};              ///< unit; {0,0,0}: black
    glm::vec3 to_eye{0};              ///< unit
    glm::vec3 base_color{1};
    std::uint32_t medium = formats::kNone;  ///< index into ReferenceScene::media; none: opaque
    SurroundingMedia around;                ///< other bodies that it lies in
    SurroundingMedia within;                ///< bodies behind it, of a medium; empty: its own alone
};

/// One sample of radiance, with the state of its path.
struct PathSample {
    glm::vec3 radiance{0};  ///< [W m^-2 sr^-1], unbiased
    /// It left a body through a hole, and began again where it had entered that body, so that what
    /// leaves there is as bright as the mean of the rest; or a number overflowed: black.
    bool lost = false;
    /// scattering events and surfaces on the path: a measure of the work
    std::uint32_t events = 0;
    /// What light of radiance 1 from `to_sky` alone, unit, would add where the path ended in the
    /// sky, but for what is sampled from the light: of a space without light, all there is.
    glm::vec3 sky{0}, to_sky{0};
};

/// Radiance that arrives along a ray against its `direction`; `around`: the bodies it starts in.
/// Volumetric path tracing. At each event from which a straight line may reach the light, the light
/// is sampled too; the balance heuristic combines both. `spread`: for PathSpace::filtering.
PathSample trace_ray(const PathSpace& space, glm::vec3 origin, glm::vec3 direction,
                     RandomStream& random, const SurroundingMedia& around = {},
                     const RaySpread& spread = {});

/// Radiance that leaves a receiver toward its eye; surfaces between them are ignored. Black where
/// the receiver has no normal or faces away (unless its material is double-sided).
PathSample trace_receiver(const PathSpace& space, const ReferenceReceiver& receiver,
                          RandomStream& random);

}  // namespace opaline::bake
