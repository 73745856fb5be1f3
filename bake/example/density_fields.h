#pragma once

#include "formats/sparse_grid.h"

namespace opaline::bake {

/// Densities from 0 to 1 of volumes that the program makes itself; lengths in metres, +Y up. The
/// same bits on every run.

/// A plume that rises from (0, base, 0) and widens as it curls: 0.5 m tall, voxels of 4 mm.
formats::SparseGrid<float> make_smoke_density(double base);

/// A fair-weather cumulus: a flat base at y = 0, heaps of billows above it, 820 m wide and 370 m
/// tall, voxels of 6 m. Denser toward the top, as droplets grow with height.
formats::SparseGrid<float> make_cumulus_density();

}  // namespace opaline::bake
