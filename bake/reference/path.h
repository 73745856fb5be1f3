#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "bake/reference/light_sampler.h"
#include "bake/reference/random_stream.h"
#include "bake/reference/reference_scene.h"
#include "bake/reference/terms.h"

namespace opaline::bake {

/// Which light of which paths is counted.
struct PathOptions {
    Terms terms = term::kAll;
    /// Most scattering events along a path: on surfaces (refraction and mirror reflection count)
    /// or in media. Crossings between equal indices do not count.
    std::uint32_t max_depth = 0xffffffffu;
    /// false: a receiver's own mirror reflection or specular lobe is left out, whatever is seen in
    /// it.
    bool own_mirror = true;
};

/// What a path walks through. All outlive the walk.
struct PathSpace {
    const ReferenceScene& scene;
    const LightSampler& light;
    PathOptions options;
};

/// A vertex that radiance is asked for at, and the direction it is seen from.
struct ReferenceReceiver {
    std::uint32_t primitive = 0, vertex = 0;  ///< numbers of formats::Scene
    glm::vec3 outside{0}, inside{0};          ///< where rays start on either side of the vertex's
                                              ///< triangles, relative to HitScene::centre
    glm::vec3 normal{0};                      ///< unit; {0,0,0}: black
    glm::vec3 to_eye{0};                      ///< unit
    glm::vec3 base_color{1};
    std::uint32_t medium = formats::kNone;  ///< index into ReferenceScene::media; none: opaque
    MediumStack around;                     ///< other bodies that it lies in
};

/// One sample of a path's radiance, and what became of the path.
struct PathSample {
    glm::vec3 radiance{0};     ///< [W m^-2 sr^-1], unbiased
    bool lost = false;         ///< it flew out of a body that is not closed, or a number overflowed
    std::uint32_t events = 0;  ///< scatterings and surfaces on its way: a measure of the work
};

/// Radiance that comes along a ray against its `direction`; `around`: the bodies it starts in.
/// Volumetric path tracing; the light is also sampled at each event from where a straight line may
/// reach it, both combined by the balance heuristic.
PathSample trace_ray(const PathSpace& space, glm::vec3 origin, glm::vec3 direction,
                     RandomStream& random, const MediumStack& around = {});

/// Radiance that leaves a receiver toward its eye, whatever stands between them. Black where the
/// receiver has no normal or faces away (unless its material is double-sided).
PathSample trace_receiver(const PathSpace& space, const ReferenceReceiver& receiver,
                          RandomStream& random);

}  // namespace opaline::bake
