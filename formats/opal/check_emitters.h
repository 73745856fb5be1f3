#pragma once

#include "formats/opal/asset.h"
#include "formats/opal/fault.h"

namespace opaline::formats {

/// What a reader of emitters relies on without further checks: names, and records that refer to
/// primitives, emitters, images and values that exist, in their order, none twice. No emitters are
/// fine. Precondition: primitives are sound.
Fault find_emitters_fault(const AssetView& asset);

/// What a sound baker never writes: halves that are infinite or not a number. Precondition:
/// find_emitters_fault found nothing.
Fault find_emitter_value_fault(const EmittersView& emitters);

}  // namespace opaline::formats
