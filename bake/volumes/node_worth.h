#pragma once

#include <cstdint>
#include <vector>

#include "bake/volumes/node_lattice.h"
#include "formats/opal/sparse_rows.h"
#include "formats/sparse_grid.h"

namespace opaline::bake {

/// The mean density around each node, linear in the distance to the next one along each axis,
/// relative to the largest of them.
std::vector<float> node_densities(const formats::SparseGrid<float>& density,
                                  const NodeLattice& lattice);

/// RMS over directions and bands of a row of V on a cube map of n x n texels: how much of the light
/// of a node reaches eyes all around, because depths are the same both ways.
float mean_visibility(const formats::SparseRow& attenuated, std::uint32_t n);

}  // namespace opaline::bake
