#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/opal/vec3.h"
#include "runtime/volumes/sun_columns.h"

namespace opaline::runtime {

/// Which volumes other than `own` may stand between its points and each sun, by number: those whose
/// table the light of that sun crosses before or while it crosses the table of `own`. Never too
/// few, but for rounding of places in the world.
std::vector<std::vector<std::size_t>> find_shades(std::span<const SunColumns> volumes,
                                                  std::size_t own,
                                                  std::span<const formats::Vec3> suns);

}  // namespace opaline::runtime
