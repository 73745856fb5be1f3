#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/section.h"

namespace opaline::formats {

/// A section on its way into the file. Its parts are its stored bytes, one after the other: they
/// point into `compressed`, or else into what the section was made of.
struct StoredSection {
    SectionEntry entry;  ///< all but the offset
    std::vector<std::span<const std::byte>> parts;
    std::vector<std::byte> compressed;

    StoredSection() = default;
    StoredSection(StoredSection&&) = default;  ///< and no copies: their parts would point elsewhere
    StoredSection& operator=(StoredSection&&) = default;
};

/// Stored as it is, instead of by zstd at a level of 1 ... 19.
inline constexpr int kNotCompressed = 0;

/// A section of arrays, each padded to kArrayAlignment so that a reader can use them in place. It
/// is compressed if a level is given and that makes it smaller.
StoredSection store_arrays(std::uint32_t id, int zstd_level,
                           std::span<const std::span<const std::byte>> arrays);

/// A section of text, its exact length.
StoredSection store_text(std::uint32_t id, std::span<const char> text);

/// Bytes from a multiple of `alignment` >= 1 that follows `size` bytes to the next.
std::size_t padding_to(std::size_t alignment, std::uint64_t size);

/// Zeros to pad with, as many as the largest alignment.
std::span<const std::byte> padding_zeros(std::size_t count);

/// A value as it stands in memory, which must outlive the span.
template <class T>
std::span<const std::byte> bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

}  // namespace opaline::formats
