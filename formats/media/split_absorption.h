#pragma once

#include <optional>

#include "formats/scene.h"

namespace opaline::formats {

/// A volume whose albedo varies as one that scatters and one that only absorbs, at the same place:
/// with A the largest albedo of all voxels and bands, and m a voxel's largest one of all bands over
/// A, the first has the density rho m and albedos of at most A, the second, which is returned,
/// rho (1 - m) and albedo 0. Their sums of extinction and of scattering are those of the volume, at
/// each voxel, and the first has one albedo everywhere unless its hue varies. Nothing is returned
/// where there is nothing to split off; light of its own stays with the first.
std::optional<Volume> split_absorption(Volume& volume);

}  // namespace opaline::formats
