#pragma once

#include <cstdint>
#include <span>

#include "bake/lights/luminance.h"
#include "bake/lights/true_irradiance.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/direction_set.h"

namespace opaline::bake {

/// True reflected luminance of opaque receivers with albedo 1: rays to the suns, dense quadrature
/// of all other light.
struct ReflectionTruth {
    DirectionSet directions;
    SunRays suns;
    std::span<const TestLight> lights;
};
/// `lights` must outlive the result.
ReflectionTruth make_reflection_truth(std::span<const TestLight> lights,
                                      const DensitySpace* between = nullptr);
/// Both estimates are equal, because the computation is deterministic. `traced` adds up.
TwoEstimates eval_reflection(const ReflectionTruth& truth, const RayScene& rays,
                             const Receiver& receiver, std::uint64_t& traced);

}  // namespace opaline::bake
