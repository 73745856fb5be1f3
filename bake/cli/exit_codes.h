#pragma once

namespace opaline::cli {

/// Exit codes (README.md of the project).
inline constexpr int kExitSuccess = 0;
inline constexpr int kExitNo = 1;  ///< the job ran and the answer is no
inline constexpr int kExitUsage = 2;
inline constexpr int kExitBadInput = 3;
inline constexpr int kExitResource = 4;
inline constexpr int kExitInterrupted = 130;

}  // namespace opaline::cli
