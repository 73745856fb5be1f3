#pragma once

#include <cstddef>

#include "bake/plan/knobs.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Points of a volume at which a quality bakes its light, at most: where the mean free path asks
/// for more, voxels are joined.
std::size_t most_nodes(Quality quality);

/// The volume with joined x joined x joined voxels in each of its own: means of density, of
/// scattering and of emission, so that extinction, scattering and power of any part of space are
/// those that it had, but for a voxel at its edge. Light resolves no finer density than that of
/// the points where it is known, and in a density that is finer it would be too dark: nodes lie
/// deeper in it than eyes look. Precondition: joined >= 1.
formats::Volume join_voxels(const formats::Volume& volume, int joined);

}  // namespace opaline::bake
