#pragma once

#include <cstddef>
#include <cstdint>

namespace opaline::formats::vdb {

/// Limits for untrusted files: far above any volume that can be baked, and low enough that a few
/// hostile bytes cannot exhaust the machine.
inline constexpr std::uint64_t kMaxFileBytes = 16ull << 30;
inline constexpr std::uint32_t kMaxBricks = 1u << 18;       ///< of 8^3 voxels, in all grids that
                                                            ///< are read; 512 MiB of scalars
inline constexpr std::uint32_t kMaxTableBricks = 1u << 24;  ///< entries of the tables of bricks, in
                                                            ///< all grids that are read
/// Largest index coordinate of a voxel, either sign: beyond, a float has no fraction left.
inline constexpr std::int64_t kMaxIndex = 1 << 24;
inline constexpr std::size_t kMaxGrids = 64;           ///< read at once
inline constexpr std::int32_t kMaxGridsInFile = 4096;  ///< listed in a file
inline constexpr std::size_t kMaxNameBytes = 255;      ///< name of a grid
inline constexpr std::size_t kMaxTextBytes = 4096;     ///< a text on its way between processes
inline constexpr std::size_t kMaxTextShown = 200;      ///< bytes of a message about a file
/// Negative values down to this share of a grid's largest value are taken for 0.
inline constexpr float kRoundedToZero = 1e-3f;
/// Voxels that are NaN or more negative, per active voxel, up to which they are set to 0.
inline constexpr double kMaxRepairedShare = 1e-3;

}  // namespace opaline::formats::vdb
