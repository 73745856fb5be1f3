#pragma once

#include <cstdint>
#include <vector>

#include "bake/effects/single/ray_single.h"
#include "bake/lights/luminance.h"
#include "bake/lights/true_irradiance.h"
#include "bake/physics/phase.h"

namespace opaline::bake {

/// Single scattering by dense quadrature: rays to suns and to the smooth part of the lights, with
/// the phase function itself instead of its terms.
struct SingleQuadrature {
    SingleMedium medium;
    PhaseDensity phase;
    SunRays suns;
    DirectionSet directions;      ///< of the smooth part, four a texel
    std::vector<float> integral;  ///< [block][lane][light]: luminance over the cell of each
    std::size_t lights = 0;
};

/// `depth_samples`: along the inward normal. `material` must have a medium.
SingleQuadrature make_single_quadrature(const formats::Scene& scene, std::uint32_t material,
                                        std::uint32_t depth_samples,
                                        std::span<const TestLight> lights,
                                        const DensitySpace* between = nullptr);

/// Luminance that leaves along the normal at `point` by single scattering, without the exit's Ft
/// (single/README.md, "Transport"). `point` must be of the medium's material. `traced` adds up.
Luminance integrate_single(const SingleQuadrature& quadrature, const RayScene& rays,
                           const BodyPoint& point, std::uint64_t& traced);

}  // namespace opaline::bake
