#pragma once

#include "formats/opal/asset.h"
#include "formats/opal/fault.h"

namespace opaline::formats {

/// What is wrong with the light of volumes; empty if nothing is. Numbers, orders and parts,
/// whatever the values. Precondition: volumes and emitters passed their own checks.
Fault find_glow_fault(const AssetView& asset);

/// Values: not finite.
Fault find_glow_value_fault(const GlowView& glow);

}  // namespace opaline::formats
