#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>

#include "formats/scene.h"

namespace opaline::bake {

/// Densities rho' and densities times albedo rho' alpha' of each voxel.
struct ScaledGrids {
    formats::SparseGrid<float> density;
    formats::SparseGrid<glm::vec3> scattering;
};

/// A volume whose forward peak f counts as not scattered: c' = c - f b, and as much is absorbed as
/// before.
struct ScaledMedium {
    std::array<float, 3> sigma_t{};  ///< c' [1/m] where the density is 1, by band
    std::array<float, 3> albedo{};   ///< of c', by band; the largest where it varies
    /// Replaces the volume's own grids; null where these are unchanged.
    std::shared_ptr<const ScaledGrids> grids = nullptr;
};

/// Where the albedo varies, so does the extinction that the peak removes: with the mean albedo A of
/// a band and r = mean over bands of (1 - f alpha) / (1 - f A) at a voxel,
///
///     sigma_t' = sigma_t (1 - f A),   rho' = rho r,   1 - alpha' = (1 - alpha) / ((1 - f A) r)
///
/// which is exact where all bands have one albedo, or one at all voxels. Else bands scatter too
/// much or too little, by their distance from r (README.md, "Albedo that varies").
ScaledMedium scale_medium(const formats::Volume& volume, double peak);

}  // namespace opaline::bake
