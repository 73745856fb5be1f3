#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/multiple/medium_profile.h"
#include "bake/receivers/receiver.h"
#include "bake/visibility/direction_set.h"
#include "bake/visibility/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A medium so dense that light leaves where it entered (translucency.md 9, opaque limit): what a
/// half space sends back of the irradiance at the receiver itself, with no samples, no tree and no
/// light maps.
struct LocalStage {
    DirectionSet directions;
    /// [band][step]: radiance toward the viewer before its own transmittance, per irradiance, at
    /// evenly spaced cosines of the light from 0 to 1,
    ///     f(c) = R Ft(c) / (pi c_exit) + alpha / (4 pi) (Ft J / c) c' / (1 + c'):
    /// T_d = R E, and the integral of translucency.md 3.6 along a path without end.
    std::vector<std::vector<float>> factor;
};

/// `multiple`: null where it is not simulated; `single`: whether that is, with one term. `bands`:
/// 3, or 1 where those of the medium coincide.
LocalStage make_local_stage(const formats::Medium& medium, const MediumProfile* multiple,
                            bool single, std::uint32_t cubemap_size, std::uint32_t bands);

/// The receiver's row: band by band, means over texels, 6 n n values each, overwritten. Returns the
/// number of rays.
std::uint64_t gather_local(const RayScene& rays, const LocalStage& stage, const Receiver& receiver,
                           std::span<float> row);

}  // namespace opaline::bake
