#pragma once

#include <cstddef>
#include <cstdint>

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
inline constexpr std::uint32_t kMinBodyVoxels = 8,
                               kMaxBodyVoxels = 256;  ///< along the longest edge
inline constexpr float kAlbedoRounding = 1e-3f;       ///< by which a voxel's albedo may exceed 1
inline constexpr double kMinEmissionScale = 1e-20, kMaxEmissionScale = 1e12;
inline constexpr double kMinTemperatureScale = 1e-6, kMaxTemperatureScale = 1e6;
inline constexpr double kMaxTemperature = 1e5;  ///< [K]; all that is hotter radiates as blue
inline constexpr double kMaxEmission = 1e15;    ///< radiance per metre [W m^-3 sr^-1]
/// Through a voxel along its longest edge; beyond, a volume is a surface, and walks through it take
/// ever more steps (bake/reference/README.md, "Volumes").
inline constexpr double kMaxVoxelDepth = 1e6;
/// Of cloud layers: lengths in metres. Heights and coordinates stay distinct as single floats.
inline constexpr double kMaxLayerCoordinate = 1e7, kMinLayerSize = 1, kMaxLayerSize = 1e7;
inline constexpr double kMaxLayerHeight = 1e6, kMinLayerGap = 0.1;  ///< gap: ground to base
inline constexpr double kMinLayerThickness = 1e-6, kMaxLayerThickness = 1e5;
inline constexpr double kMaxWind = 1e4;  ///< [m/s]
inline constexpr double kMinVisibility = 1, kMaxVisibility = 1e7;
inline constexpr double kMaxPeakAngle = 20;                       ///< [degrees]
inline constexpr double kMinDroplets = 1e3, kMaxDroplets = 1e13;  ///< per volume [1/m^3]
inline constexpr double kMinDropletRadius = 1e-7, kMaxDropletRadius = 1e-4;
inline constexpr double kMinDropletGamma = 0.1, kMaxDropletGamma = 1e4;
inline constexpr double kMaxDropletShare = 0.01;  ///< of the volume; denser ones are no cloud
inline constexpr std::uint32_t kMinFieldSide = 2, kMaxFieldSide = 4096;       ///< texels
inline constexpr std::uint32_t kMinFormulaSide = 16, kMaxFormulaSide = 2048;  ///< texels
inline constexpr std::uint32_t kMaxFieldFrames = 4096;                        ///< of a layer
inline constexpr std::size_t kMaxFieldTexels = std::size_t{1} << 26;  ///< of all frames together
inline constexpr double kMinFrameSeconds = 0.01, kMaxFrameSeconds = 1e8;
/// Of an evolution. With fewer frames blends between them lose their shape.
inline constexpr double kMinEvolutionPeriod = 1, kMaxEvolutionPeriod = 1e8;  ///< [s]
inline constexpr std::uint32_t kMinEvolutionFrames = 4, kMaxEvolutionFrames = 256;
inline constexpr double kMinCellTexels = 4;  ///< that a cell or wave of a formula takes

}  // namespace opaline::formats::media
