#pragma once

#include <cstdint>

#include "bake/exchange/bounce_light.h"

namespace opaline::bake {

/// Places sites among the receivers and gathers light there: BounceLight::sites and site_rows.
/// Counts `rays`.
void light_sites(const LightInputs& inputs, BounceLight& light, std::uint64_t& rays);

}  // namespace opaline::bake
