#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/asset.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// Writes a whole asset, and does not commit the file. The bytes depend on the arguments alone.
/// `receiver_errors`: one for each receiver (receiver_errors.h), or none.
Status write_opal_bytes(const AssetView& asset, AtomicFile& file,
                        std::span<const float> receiver_errors = {});

/// The same without errors by receiver, and commits the file.
Status write_opal(const AssetView& asset, AtomicFile file);

/// Size [bytes] of the file that write_opal makes.
std::uint64_t opal_size(const AssetView& asset);

}  // namespace opaline::formats
