#pragma once

#include "formats/opal/asset.h"
#include "formats/opal/fault.h"

namespace opaline::formats {

/// What a reader of holes relies on without further checks: records of primitives and images that
/// exist, in their order, none twice; alpha of all vertices or of none. No holes are fine.
/// Precondition: primitives are sound.
Fault find_holes_fault(const AssetView& asset);

/// What a sound baker never writes: alpha of vertices that is not in [0, 1].
Fault find_hole_value_fault(const HolesView& holes);

}  // namespace opaline::formats
