#pragma once

#include "formats/opal/asset.h"
#include "formats/opal/fault.h"

namespace opaline::formats {

/// What a reader of normal maps relies on without further checks: records of primitives and images
/// that exist, in their order, none twice; tangents, which may have any value, of all vertices. No
/// maps are fine.
/// Precondition: primitives are sound.
Fault find_normal_maps_fault(const AssetView& asset);

}  // namespace opaline::formats
