#pragma once

#include <cstdint>

#include "bake/effects/multiple/walks/exit_lobe.h"
#include "bake/effects/multiple/walks/walk_space.h"
#include "bake/lights/luminance.h"
#include "bake/lights/true_irradiance.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

struct BounceTruth;  // exchange/true_bounces.h

/// What the walks of a receiver see of their surroundings.
struct WalkLight {
    const RayScene& rays;
    const SunRays& suns;
    const SmoothLights& smooth;
    ExitLobe lobe;            ///< of the medium's boundary
    double escape = 1;        ///< c_exit
    std::uint32_t walks = 0;  ///< for each of the two estimates
    glm::vec3 seen{0};        ///< unit, inside, toward the eye; 0: the mean over all views
    /// Of other light, which enters as diffuse light does; null: there is none.
    const BounceTruth* other = nullptr;
};

/// Luminance that leaves the surface at a receiver toward its normal, less the factor F_t, by light
/// that scattered more than once: walks from the receiver itself, whose exits look at the lights by
/// rays of their own. No sites, samples, cube map or wavelets of the bake. `key`: of the random
/// numbers. `traced` adds up.
TwoEstimates walk_to_lights(const WalkSpace& space, const WalkLight& light, const BodyPoint& point,
                            WalkOrders orders, std::uint64_t seed, std::uint32_t key,
                            std::uint64_t& traced);

}  // namespace opaline::bake
