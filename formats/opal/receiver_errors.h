#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/read_opal.h"
#include "formats/opal/result.h"
#include "formats/opal/section.h"

namespace opaline::formats {

/// How far the stored rows of each receiver are from those that the baker had (formats/README.md,
/// `RERR`). For tools alone: read_opal skips the section, so that runtimes do not carry it.

inline constexpr std::uint32_t kRerrSection = section_id("RERR");
inline constexpr std::uint32_t kRerrVersion = 1;

struct ReceiverErrorsHead {
    std::uint32_t receivers = 0;
    std::uint32_t reserved[3] = {};
};
static_assert(sizeof(ReceiverErrorsHead) == 16);

/// One number >= 0 for each receiver of the file that `loaded` was read from; empty where it has no
/// such section. Untrusted input is safe, and the checksum is looked at. Errors: bad_input (what is
/// damaged), newer_file.
Result<std::vector<float>> read_receiver_errors(std::span<const std::byte> bytes,
                                                const LoadedAsset& loaded, const std::string& file);

/// Mean, 95th percentile (nearest rank) and largest. All 0 without any.
struct ErrorSummary {
    double mean = 0, p95 = 0, largest = 0;
};
ErrorSummary summarize_errors(std::span<const float> errors);

}  // namespace opaline::formats
