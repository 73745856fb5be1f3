#pragma once

#include <filesystem>
#include <vector>

#include "formats/media/media_file.h"
#include "formats/opal/result.h"
#include "formats/opal/rgb.h"
#include "formats/scene.h"
#include "formats/vdb/read_vdb.h"

namespace opaline::formats {

/// Radiance of a black body at `kelvin`, weighted with the eye's response and in linear Rec. 709:
/// its luminance [cd/m^2] is 683 lm/W times the integral of Planck's law times y over 360 to 830
/// nm, so that it agrees with light from glTF, which is in nits. Channels below 0 (blue, below 1900
/// K) are 0. To a hundredth, the accuracy of the matching functions [Wyman2013]. Precondition: 0 <=
/// kelvin, finite; 0 is black.
Rgb black_body_radiance(double kelvin);

/// Reads the grid of albedos that an entry names for a volume, if any: sets `volume.scattering` and
/// `volume.albedo`, to the largest of each band; where all voxels with density have one albedo,
/// that alone. `volume` has its density already, whose transform in its file is `density_space`. A
/// grid of another transform is sampled at the voxels of the density, linear between its own; a
/// warning says so where that loses details. Where the grid has no value the albedo is 0.
///
/// Errors, `bad_input`: those of read_vdb, and albedos above 1 by more than rounding.
Status load_albedo(const VolumeEntry& entry, const std::filesystem::path& file,
                   const glm::dmat4& density_space, const VdbReadOptions& reader, Volume& volume,
                   std::vector<Diagnostic>& warnings);

/// Reads the light of its own that an entry gives to a volume, if any: sets `volume.emission` and
/// `volume.emitter`, and widens the tables of its other grids so that all have the same one.
/// `volume` is complete but for these; `density_space` is the density's transform in its file.
///
/// A grid of another transform than the density's is sampled at the voxels of the density, linear
/// between its own; a warning says so where that loses details. Temperatures T become radiance per
/// metre (1 - albedo) sigma_t density L_e(T) (Kirchhoff), L_e that of black_body_radiance, at each
/// voxel.
///
/// Errors, `bad_input`: those of read_vdb, a grid of colours as temperature, temperatures above 1e5
/// K, more than 1e15 W m^-3 sr^-1, and a grid that takes too many voxels of the density's size.
Status load_emission(const VolumeEntry& entry, const std::filesystem::path& file,
                     const glm::dmat4& density_space, const VdbReadOptions& reader, Volume& volume,
                     std::vector<Diagnostic>& warnings);

}  // namespace opaline::formats
