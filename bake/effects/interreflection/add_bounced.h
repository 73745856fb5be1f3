#pragma once

#include <cstdint>
#include <span>

#include "bake/effects/interreflection/bounce_light.h"
#include "bake/transport/other_light.h"

namespace opaline::bake {

/// Adds irradiance at a point, Haar rows as of OtherLight::add: interpolated from the sites around,
/// or by final gathering where these are too few. Returns the rays traced, 0 if interpolated.
std::uint64_t add_bounced(const BounceLight& light, const LitPoint& point,
                          std::uint32_t cubemap_size, std::span<float> rows);

}  // namespace opaline::bake
