#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/atomic_file.h"
#include "formats/opal/result.h"
#include "runtime/picture/picture.h"
#include "runtime/picture/tone_map.h"

namespace opaline::cli {

/// A file that a command is going to write.
struct OutputFile {
    std::string option;  ///< that names it, for messages
    std::filesystem::path path;
    std::vector<std::string> endings;  ///< that it may have, in lower case; empty: any
};

/// Refuses outputs that are the same file as an input or as each other, also through links, and
/// endings that are not among those of the output. Devices and pipes may be named twice.
/// Errors: usage.
formats::Status check_outputs(std::span<const OutputFile> outputs,
                              std::span<const std::filesystem::path> inputs);

/// Outputs before the work, so that an unwritable folder fails at once. Throws Refusal.
std::vector<formats::AtomicFile> create_outputs(std::span<const OutputFile> outputs);

/// All of them or none, as far as the disk allows: what may fail comes before the first name.
void commit_outputs(std::span<formats::AtomicFile> files);

/// The ending of a path in lower case, its dot included: ".png" of "A.PNG".
std::string ending_of(const std::filesystem::path& path);

/// Radiance times 2^exposure as OpenEXR, or tone-mapped as PNG: by the ending of the path, which is
/// one of the two. Errors: resource.
formats::Status write_picture(const std::string& path, const runtime::Picture& picture,
                              float exposure, runtime::ToneMap map = runtime::ToneMap::neutral);

}  // namespace opaline::cli
