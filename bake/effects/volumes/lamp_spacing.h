#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

#include "bake/plan/knobs.h"
#include "formats/scene.h"
#include "formats/sparse_grid.h"

namespace opaline::bake {

/// Largest distance of nodes in voxels, 1, 2, 4 or 8, for each brick of a grid, by how fast light
/// of lamps changes there: that of a point within its distance, that of a beam within its width.
/// Empty where no lamp of the scene has a place, or --effects leaves lamps out.
std::vector<std::uint32_t> lamp_spacings(const formats::Scene& scene,
                                         const formats::SparseGrid<float>& density,
                                         const Knobs& knobs);

/// The largest of these distances, at most `spacing`, that is close enough in bricks with half of
/// the density.
std::uint32_t typical_spacing(const std::vector<std::uint32_t>& of_bricks,
                              const formats::SparseGrid<float>& density, std::uint32_t spacing);

}  // namespace opaline::bake
