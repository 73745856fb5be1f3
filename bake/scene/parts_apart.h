#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// The primitives of a material that have triangles, in sets whose bounding boxes are apart: no
/// point of one set is a point of another. Sets and their members in the order of the scene.
std::vector<std::vector<std::uint32_t>> list_parts_apart(const formats::Scene& scene,
                                                         std::uint32_t material);

/// How many times as large a primitive is as another of the same mesh, where it is the same shape,
/// moved, turned and scaled evenly, within the rounding of positions; nothing where it is not.
std::optional<double> scale_of_copy(const formats::Primitive& copy, const formats::Primitive& of);

}  // namespace opaline::bake
