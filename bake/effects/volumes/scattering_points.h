#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/trace/density/density_space.h"

namespace opaline::bake {

/// A point of a ray where a volume scatters light into it.
struct ScatteringPoint {
    glm::vec3 position{0};     ///< [m]
    std::uint32_t volume = 0;  ///< of the scene
    /// By band: J at the point times this, summed over the points, is the radiance that arrives.
    std::array<float, 3> weight{};
};

/// Points along a ray against which light comes that was scattered over `reach` [m], maybe
/// infinite: one in each of `count` equal parts of
///     int e^-tau c' dt,   c' the scattering coefficient without the forward peak,
/// the mean over bands, from `shift` in [0, 1) on; none where nothing is scattered. Depths are sums
/// over steps of at most a voxel, and the weights of all parts telescope: without absorption they
/// sum to 1 - e^-tau. Overwrites `points`. `sends`: by volume, whether it counts; all volumes dim.
void find_scattering_points(const DensitySpace& space, const std::vector<bool>& sends,
                            glm::vec3 from, glm::vec3 direction, float reach, std::uint32_t count,
                            float shift, std::vector<ScatteringPoint>& points);

}  // namespace opaline::bake
