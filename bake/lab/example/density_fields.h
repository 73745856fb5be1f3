#pragma once

#include "formats/sparse_grid.h"

namespace opaline::bake {

/// Densities from 0 to 1 of volumes that the program makes itself; lengths in metres, +Y up. The
/// same bits on every run.

/// A plume that rises from (0, base, 0) and widens as it curls: 0.5 m tall, voxels of 4 mm.
formats::SparseGrid<float> make_smoke_density(double base);

/// A camp fire that stands on y = 0 and its smoke, 0.6 m tall: voxels of 6 mm. Tongues of flame are
/// soot; above them it thins and drifts away as smoke.
formats::SparseGrid<float> make_fire_density();

/// Temperatures [K] of the same voxels: 1900 K within the flames, cold above 0.35 m.
formats::SparseGrid<float> make_fire_temperature();

/// A fair-weather cumulus: a flat base at y = 0, heaps of billows above it, 820 m wide and 370 m
/// tall, voxels with edges of `voxel` [m], at least 1. Denser toward the top, as droplets grow with
/// height.
formats::SparseGrid<float> make_cumulus_density(double voxel = 6);

/// A block of even density 1, 3 mm wide, 1.5 mm tall and 2 mm deep, on y = 0: voxels of 0.05 mm.
formats::SparseGrid<float> make_block_density();

/// A cloud of gradient noise in an ellipsoid 1 m wide, on y = 0: holes and lumps of all sizes down
/// to its voxels of 16 mm.
formats::SparseGrid<float> make_noise_density();

}  // namespace opaline::bake
