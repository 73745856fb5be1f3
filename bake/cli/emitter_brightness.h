#pragma once

#include <vector>

#include "formats/opal/asset.h"

namespace opaline::cli {

/// How much brighter each emitter of a file makes it than a sky of radiance 1: the mean luminance
/// of all receivers by its light alone over that under the sky, each receiver seen along its
/// normal. NaN where the sky gives no light, or the file has no receivers.
std::vector<double> compare_with_sky(const formats::AssetView& view);

}  // namespace opaline::cli
