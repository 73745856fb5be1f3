#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bake/exchange/bounce_light.h"
#include "bake/lights/true_irradiance.h"

namespace opaline::bake {

/// Light from other surfaces by tracing paths from surface to surface, each with its own light of
/// the environment: no scatterers, footprints or cube map where paths meet opaque and thin-walled
/// surfaces. What leaves a medium is that of the nearest scatterer, in which a path ends. Volumes
/// `between` dim the light of the environment on its way to the first surface.
struct BounceTruth {
    std::shared_ptr<const BounceLight> light;
    SunRays suns;
    SmoothLights smooth;
    std::vector<std::vector<float>> coarse;  ///< the lights at the cube map of `light`
};
BounceTruth make_bounce_truth(std::shared_ptr<const BounceLight> light,
                              std::span<const TestLight> lights,
                              const DensitySpace* between = nullptr);

/// Adds the luminance of the irradiance under each light, the mean of `count` paths. Unbiased. The
/// random numbers are keyed by `key`. Returns the rays.
std::uint64_t add_true_bounces(const BounceTruth& truth, const Receiver& at, std::uint64_t key,
                               std::uint32_t count, std::span<double> irradiance);

/// Adds the luminance of `weight` times the radiance that arrives against the unit direction
/// `along.normal` at `along.origin` from the surface there, under each light, by one path: the
/// number-th of `key`. Unbiased, but that it counts as the same in all directions. Returns the
/// rays.
std::uint64_t add_true_view(const BounceTruth& truth, const Receiver& along, formats::Rgb weight,
                            std::uint64_t key, std::uint32_t number, std::span<double> luminance);

}  // namespace opaline::bake
