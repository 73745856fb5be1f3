#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>

#include "bake/plan/dense_rows.h"
#include "bake/transport/other_light.h"
#include "bake/truth/luminance.h"

namespace opaline::bake {

/// What a row takes of irradiance: radiance per irradiance, band by band.
struct OtherLightShare {
    std::uint32_t term = 0;
    std::array<float, 3> factor{};
};

/// Adds shares of the irradiance of `light` at a point to the rows of a receiver. Of light with
/// three bands a row of one band takes the luminance. Returns the rays traced: none where `light`
/// is null.
std::uint64_t add_other_light(const OtherLight* light, const Receiver& receiver,
                              std::initializer_list<OtherLightShare> shares, const DenseRow& row);

/// Adds share / pi of the true irradiance of other light, two independent estimates, to those of
/// the radiance of a diffuse surface. Empty `light`: nothing. Returns the rays.
std::uint64_t add_true_other_light(const OtherLight::TrueIrradiance& light,
                                   const Receiver& receiver, std::uint64_t key, double share,
                                   TwoEstimates& radiance);

}  // namespace opaline::bake
