#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "bake/measure/true_multiple.h"
#include "bake/measure/true_single.h"
#include "bake/receivers/receiver.h"
#include "bake/visibility/direction_set.h"

namespace opaline::bake {

/// What receivers of an opaque surface truly reflect, albedo 1: rays to the suns, dense quadrature
/// of all else.
struct DirectTruth {
    DirectionSet directions;
    SunRays suns;
};
DirectTruth make_direct_truth(std::span<const TestLight> lights);
/// Both estimates are the same: no chance is in it. `traced` adds up.
TwoEstimates eval_truth(const DirectTruth& truth, const RayScene& rays, const Receiver& receiver,
                        std::span<const TestLight> lights, std::uint64_t& traced);

/// What receivers of a medium's boundary truly send out along their normals, but for the exit's Ft.
struct TranslucentTruth {
    std::optional<SurfaceIntegral> multiple;
    std::optional<SingleQuadrature> single;
    SunRays suns;  ///< of the surface integral
    SmoothLights smooth;
    std::uint32_t points = 1024;  ///< of the surface, for each of the two estimates
};
/// `multiple`: the medium's profile, null where light that scatters many times is left out.
/// `depth_samples` of single scattering; 0: left out.
TranslucentTruth make_translucent_truth(const formats::Scene& scene, std::uint32_t material,
                                        const MediumProfile* multiple, std::uint32_t depth_samples,
                                        std::span<const TestLight> lights);
/// `receiver`, `seed`: key the random numbers. `traced` adds up.
TwoEstimates eval_truth(const TranslucentTruth& truth, const formats::Scene& scene,
                        const RayScene& rays, const BodyPoint& point, std::uint64_t seed,
                        std::uint32_t receiver, std::uint64_t& traced);

}  // namespace opaline::bake
