#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/asset.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// How the sections of rows, volumes, cloud layers and emitters are stored: as they are, so that a
/// reader uses them in place, or by zstd at level 3 or 19. The others are small or compressed
/// anyway.
enum class Compression { none, fast, best };

/// Writes a whole asset, and does not commit the file. The bytes depend on the arguments alone.
/// `receiver_errors`: one for each receiver (receiver_errors.h), or none.
Status write_opal_bytes(const AssetView& asset, AtomicFile& file,
                        std::span<const float> receiver_errors = {},
                        Compression compression = Compression::none);

/// The same without errors by receiver and compression, and commits the file.
Status write_opal(const AssetView& asset, AtomicFile file);

/// Size [bytes] of the file that write_opal_bytes makes of it without errors by receiver.
std::uint64_t opal_size(const AssetView& asset, Compression compression = Compression::none);

}  // namespace opaline::formats
