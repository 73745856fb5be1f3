#pragma once

#include <cstddef>

namespace opaline::formats::media {

/// Bounds on the values of a media file, so that all derived values stay finite.
inline constexpr double kMaxCoefficientPerM = 1e12;  ///< far above any real scattering coefficient
inline constexpr double kMaxMeanCosine = 0.99;       ///< beyond, a phase function is nearly a delta
inline constexpr double kMinRmsAngle = 1e-3;         ///< [rad]
inline constexpr double kMinEta = 1.0 / 3.0, kMaxEta = 3.0;
inline constexpr double kMaxTableValue = 1e30, kMinTableIntegral = 1e-30;
inline constexpr std::size_t kMaxTableRows = 65536;
inline constexpr double kMinThickness = 1e-9, kMaxThickness = 1e3;      ///< [m]
inline constexpr double kMinMarbleScale = 1e-6, kMaxMarbleScale = 1e6;  ///< [m]
inline constexpr std::size_t kMaxMarbleColors = 16;
inline constexpr double kMaxVolumeCoordinate = 1e9;  ///< of a corner of a volume [m]
inline constexpr double kMinDensityScale = 1e-12, kMaxDensityScale = 1e12;
/// Through a voxel along its longest edge; beyond, a volume is a surface, and walks through it take
/// ever more steps (bake/reference/README.md, "Volumes").
inline constexpr double kMaxVoxelDepth = 1e6;

}  // namespace opaline::formats::media
