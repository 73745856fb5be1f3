#pragma once

#include <optional>
#include <string>

#include "bake/effects/multiple/walks/walk.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// A warning where a thousandth or more of the light of a material's walks ends before it leaves
/// the surface: how much, why, and how it is corrected (WalkCounts::correction). `material`: its
/// name.
std::optional<formats::Diagnostic> describe_unfinished(const std::string& material,
                                                       const WalkCounts& counts);

}  // namespace opaline::bake
