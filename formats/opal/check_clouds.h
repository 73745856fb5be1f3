#pragma once

#include "formats/opal/clouds.h"
#include "formats/opal/fault.h"

namespace opaline::formats {

/// Logarithms of a phase function [1/sr] lie in kMinLogPhase ... kMaxLogPhase: what they are of is
/// finite and not 0.
inline constexpr float kMinLogPhase = -100, kMaxLogPhase = 40;
/// Of the glow [1/sr] and of the absolute values of the radiance tables.
inline constexpr float kMaxLayerValue = 1e9f;

/// What a reader of layers relies on without further checks: all of the records. Numbers that are
/// finite and in the ranges of LayerRecord, counts that exist, parts inside their arrays, each
/// behind the one of the layer before it. No layers are fine.
Fault find_clouds_fault(const CloudsView& clouds);

/// What a sound baker never writes: values of tables that are not finite or out of range, colours
/// of the ground whose last byte is not 255. Precondition: find_clouds_fault found nothing.
Fault find_cloud_value_fault(const CloudsView& clouds);

}  // namespace opaline::formats
