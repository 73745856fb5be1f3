#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/lights/luminance.h"
#include "bake/lights/true_irradiance.h"
#include "bake/receivers/surface_points.h"
#include "bake/scene/separate_bodies.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

struct BounceTruth;  // exchange/true_bounces.h

/// Monte Carlo estimate of the diffusion integral over a medium's surface, with its own points and
/// rays: no samples, tree, cube map or wavelets of the bake.
struct SurfaceIntegral {
    struct Triangle {
        std::array<glm::vec3, 3> corner;  ///< [m]
        AreaTable::Triangle place;
        std::uint32_t body = 0;  ///< of `bodies`
    };
    std::vector<Triangle> triangles;
    SeparateBodies bodies;  ///< through the air between them no light diffuses
    GatherProfile profile;  ///< of samples infinitely dense
    float smallest = 0;     ///< [m] profile length of the densest band
    double scale = 0;       ///< 1 / (pi c_exit)
    double all_orders = 1;  ///< MediumProfile's, mean by luminance: of other light
    double eta = 1;
};

/// `profile`: of the scene's medium `material`.
SurfaceIntegral make_surface_integral(const formats::Scene& scene, std::uint32_t material,
                                      const MediumProfile& profile);

/// What the integrand sees of its surroundings.
struct SurfaceLight {
    const formats::Scene& scene;
    const RayScene& rays;
    const SunRays& suns;
    const SmoothLights& smooth;
    std::uint32_t points = 0;  ///< of the surface, for each of the two estimates
    /// Of other light, which enters as diffuse light does; null: there is none.
    const BounceTruth* other = nullptr;
};

/// Keys of the random numbers.
struct IntegralKey {
    std::uint64_t seed = 0;
    std::uint32_t receiver = 0;
};

/// Luminance that leaves the surface at `position` [m] by multiple scattering,
///     1 / (pi c_exit) int R_d(|x - y|) E(y) dA,    README.md, "Transport",
/// from `light.points` points for each estimate, chosen as R_d dA is distributed, at equal steps of
/// its cumulative distribution. `traced` adds up.
TwoEstimates integrate_multiple(const SurfaceIntegral& integral, const SurfaceLight& light,
                                glm::vec3 position, IntegralKey key, std::uint64_t& traced);

}  // namespace opaline::bake
