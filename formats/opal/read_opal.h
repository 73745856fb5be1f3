#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/opal/section.h"

namespace opaline::formats {

/// An asset read in place. `view` points into the bytes given to `read_opal`, which must outlive
/// it, and into `decoded` for the sections that were compressed.
struct LoadedAsset {
    AssetView view;
    std::vector<SectionEntry> sections;
    std::vector<std::unique_ptr<std::byte[]>> decoded;
};

enum class Checks {
    structure,  ///< every count, offset and index that memory safety depends on
    full        ///< also checksums, finite numbers and value ranges: `opaline verify`
};

/// Reads an `.opal` file from memory; `bytes` 64-byte aligned. Untrusted input is safe: every count
/// is checked against the size of its section before use, and nothing is allocated on an unchecked
/// size. Errors: bad_input (what is damaged, and where), newer_file (written by a later version).
/// Unknown sections are skipped.
Result<LoadedAsset> read_opal(std::span<const std::byte> bytes, const std::string& file,
                              Checks checks = Checks::structure);

}  // namespace opaline::formats
