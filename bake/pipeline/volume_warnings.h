#pragma once

#include <optional>
#include <vector>

#include "bake/accuracy/volumes/volume_error.h"
#include "bake/plan/knobs.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Warns where volumes err by more than the target, or without one surely by more than passes
/// unnoticed (acceptable_error).
void warn_of_volumes(const Knobs& knobs, const std::optional<VolumeErrorReport>& error,
                     std::vector<formats::Diagnostic>& warnings);

}  // namespace opaline::bake
