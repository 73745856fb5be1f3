#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/measure/measure_error.h"
#include "bake/measure/true_irradiance.h"
#include "bake/multiple/gather_profile.h"
#include "bake/receivers/surface_points.h"
#include "bake/visibility/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The diffusion integral over a medium's surface as Monte Carlo takes it: at points of its own
/// with rays of its own, without the bake's samples, tree, cube map or wavelets.
struct SurfaceIntegral {
    struct Triangle {
        std::array<glm::vec3, 3> corner;  ///< [m]
        AreaTable::Triangle place;
    };
    std::vector<Triangle> triangles;
    GatherProfile profile;  ///< of samples infinitely dense
    float smallest = 0;     ///< [m] what the profile falls over in the densest band
    double scale = 0;       ///< 1 / (pi c_exit)
    double eta = 1;
};

/// `profile`: of the scene's medium `material`.
SurfaceIntegral make_surface_integral(const formats::Scene& scene, std::uint32_t material,
                                      const MediumProfile& profile);

/// Luminance that leaves the surface at `position` [m] by multiple scattering,
///     1 / (pi c_exit) int R_d(|x - y|) E(y) dA,    translucency.md 3.3 and 3.5,
/// from `points` points for each estimate, chosen as R_d dA is distributed, at equal steps of its
/// cumulative distribution. `receiver`, `seed`: key the random numbers. `traced` adds up.
TwoEstimates integrate_multiple(const SurfaceIntegral& integral, const formats::Scene& scene,
                                const RayScene& rays, const SunRays& suns,
                                const SmoothLights& smooth, glm::vec3 position,
                                std::uint32_t points, std::uint64_t seed, std::uint32_t receiver,
                                std::uint64_t& traced);

}  // namespace opaline::bake
