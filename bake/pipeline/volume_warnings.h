#pragma once

#include <optional>
#include <vector>

#include "bake/accuracy/volumes/volume_error.h"
#include "bake/plan/knobs.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Warns where the error of volumes exceeds the target or, without one, the lower end of its
/// interval exceeds acceptable_error.
void warn_of_volumes(const Knobs& knobs, const std::optional<VolumeErrorReport>& error,
                     std::vector<formats::Diagnostic>& warnings);

}  // namespace opaline::bake
