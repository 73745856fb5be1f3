#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/opal/vec3.h"
#include "runtime/volumes/sun_columns.h"

namespace opaline::runtime {

/// Numbers of the volumes other than `own` that may shadow its points from each sun: those whose
/// table the light of that sun crosses before or while it crosses the table of `own`. Conservative
/// up to the rounding of positions.
std::vector<std::vector<std::size_t>> find_shades(std::span<const SunColumns> volumes,
                                                  std::size_t own,
                                                  std::span<const formats::Vec3> suns);

}  // namespace opaline::runtime
