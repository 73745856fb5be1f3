#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "formats/opal/rgb.h"

namespace opaline::formats {

/// Positions in the CIE 1931 (x, y) diagram: red, green, blue, white.
using Chromaticities = std::array<float, 8>;

/// Linear RGB to linear RGB.
using ColorMatrix = glm::dmat3;

/// From linear RGB of these primaries to linear Rec. 709. The white of one becomes the white of the
/// other, by Bradford's adaptation (Lindbloom; ICC.1:2010, annex E). The identity if they are those
/// of Rec. 709 to .002. None if they span no colours (primaries on a line, a white without light).
std::optional<ColorMatrix> to_rec709(const Chromaticities& from);

/// Values that are not finite stay as they are.
void convert_colors(const ColorMatrix& matrix, std::vector<Rgb>& pixel);

}  // namespace opaline::formats
