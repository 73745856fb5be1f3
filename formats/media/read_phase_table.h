#pragma once

#include <filesystem>

#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::formats {

/// Reads a measured phase function, the file that a media file's {"type": "table"} names: see
/// parse_phase_table (read_phase.h). Untrusted input is safe.
/// Errors: `bad_input` for a file that is missing or faulty, `resource` past memory or limits.
Result<PhaseFunction> read_phase_table(const std::filesystem::path& path);

}  // namespace opaline::formats
