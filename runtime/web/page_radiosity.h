#pragma once

#include "runtime/clouds/layer_light.h"
#include "runtime/web/data_script.h"

namespace opaline::runtime {

/// What a page needs to solve the light between the ground and the base of a layer by itself, for
/// any light and time: how planes gather from each other (plane_gather.h), which depends on the
/// grid of cells alone, and how many passes are enough whatever part of the layer is above a cell.
/// `plan steps`: columns, rows, whether they wrap, passes; then by level its columns, rows, number
/// of Gaussians and where in `plan values` the mixes begin: of reductions along x and z, of
/// spreading along x and z; then of each Gaussian along x, along z: first cell, count, place of the
/// weights. A mix takes eight values: first cell, count, six weights. `plan step`: a quarter of a
/// cell along x and z [m], where cells are sampled.
/// `light`: of any light and time.
void put_radiosity(DataScript& script, const LayerLight& light);

}  // namespace opaline::runtime
