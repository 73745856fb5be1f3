#pragma once

#include <string>

#include "formats/image/image.h"

namespace opaline::bake {

/// The sea with sheets of pack ice, that break into floes at their edges, on a square of 24 km seen
/// from above: sRGB codes of the albedo. Repeats without a seam.
formats::Image8 make_icy_sea();

/// A media file (formats/media/README.md) of a layer of stratocumulus with gaps, 800 m above the
/// ground of the picture `ground`: both go on to the horizon.
std::string describe_stratus(const std::string& ground);

}  // namespace opaline::bake
