#pragma once

#include <cstdint>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Materials with a medium in the order in which they give way: where bodies of several overlap,
/// the last of them fills the space [Schmidt2002]. That is the one whose bodies enclose the least
/// volume, the first of the scene where volumes are the same: what lies inside another wins, and
/// the wall of a glass stays where a drink was modelled into it. Bodies of one medium are one.
std::vector<std::uint32_t> order_media(const formats::Scene& scene);

}  // namespace opaline::bake
