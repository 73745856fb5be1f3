#pragma once

#include "formats/opal/asset.h"
#include "formats/opal/terms.h"
#include "runtime/part_lights.h"

namespace opaline::cli {

/// How far an asset with fewer coefficients is from the whole one under a light: root mean square
/// of the difference of outgoing radiance over that of the whole, of 4096 receivers at most, in
/// equal steps. 0 without any light. Precondition: the same receivers.
double coefficient_error_of(const formats::AssetView& whole, const formats::AssetView& shortened,
                            const runtime::PartLights& light, formats::TermSet terms);

}  // namespace opaline::cli
