#pragma once

#include <cstdint>

#include "formats/opal/asset.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// Writes a whole asset, and does not commit the file. The bytes depend on the asset alone.
Status write_opal_bytes(const AssetView& asset, AtomicFile& file);

/// The same, and commits the file.
Status write_opal(const AssetView& asset, AtomicFile file);

/// Size [bytes] of the file that write_opal makes.
std::uint64_t opal_size(const AssetView& asset);

}  // namespace opaline::formats
