#pragma once

#include <cstdint>
#include <vector>

#include "bake/scene/scene_facts.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Finds the media inside each medium (MaterialFacts::inner) and those that lie in others
/// altogether (is_buried), and takes bodies with several media for grey only if all of these are.
/// `facts`: boxes and colours are known.
///
/// A connected part of a surface that meets none of another body's triangles lies inside of that
/// body if one of its points does: two of three lines from there leave the body once more than they
/// enter it. Where surfaces meet, some points of each decide.
void find_nested_media(const formats::Scene& scene, SceneFacts& facts);

/// Materials with a medium in the order in which they give way: where bodies of several overlap,
/// the last of them fills the space [Schmidt2002]. That is the one whose bodies enclose the least
/// volume, the first of the scene where volumes are the same: what lies inside another wins, and
/// the wall of a glass stays where a drink was modelled into it. Bodies of one medium are one.
std::vector<std::uint32_t> order_media(const formats::Scene& scene);

}  // namespace opaline::bake
