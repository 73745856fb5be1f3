#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/result.h"

namespace opaline::formats {

/// The container: a header, a section table, sections aligned to 64 bytes (formats/README.md).

inline constexpr std::array<char, 8> kOpalMagic{'O', 'P', 'A', 'L', 'I', 'N', 'E', '\n'};
inline constexpr std::uint32_t kEndianMark = 0x01020304u;
inline constexpr std::size_t kSectionAlignment = 64;
inline constexpr std::uint32_t kMaxSections = 1024;

enum class Codec : std::uint32_t { none = 0, zstd = 1 };

constexpr std::uint32_t section_id(const char (&name)[5]) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(name[0])) |
           static_cast<std::uint32_t>(static_cast<unsigned char>(name[1])) << 8 |
           static_cast<std::uint32_t>(static_cast<unsigned char>(name[2])) << 16 |
           static_cast<std::uint32_t>(static_cast<unsigned char>(name[3])) << 24;
}
/// The four letters of an id, unprintable ones as '?'.
std::string section_name(std::uint32_t id);

inline constexpr std::uint32_t kProvSection = section_id("PROV");
inline constexpr std::uint32_t kBasiSection = section_id("BASI");
inline constexpr std::uint32_t kPrimSection = section_id("PRIM");
inline constexpr std::uint32_t kMeshSection = section_id("MESH");
inline constexpr std::uint32_t kImagSection = section_id("IMAG");
inline constexpr std::uint32_t kSpecSection = section_id("SPEC");
inline constexpr std::uint32_t kGlosSection = section_id("GLOS");
inline constexpr std::uint32_t kHoleSection = section_id("HOLE");
inline constexpr std::uint32_t kRefiSection = section_id("REFI");
inline constexpr std::uint32_t kNormSection = section_id("NORM");
inline constexpr std::uint32_t kTranSection = section_id("TRAN");
inline constexpr std::uint32_t kSharSection = section_id("SHAR");
inline constexpr std::uint32_t kMixrSection = section_id("MIXR");
inline constexpr std::uint32_t kCopySection = section_id("COPY");
inline constexpr std::uint32_t kVoluSection = section_id("VOLU");
inline constexpr std::uint32_t kClouSection = section_id("CLOU");
inline constexpr std::uint32_t kEmitSection = section_id("EMIT");
inline constexpr std::uint32_t kGlowSection = section_id("GLOW");

struct FileHeader {
    std::array<char, 8> magic = kOpalMagic;
    std::uint32_t version = 0;
    std::uint32_t endian_mark = kEndianMark;
    std::uint64_t file_size = 0;  ///< of the whole file, so that truncation shows at once
    std::uint32_t section_count = 0;
    std::uint32_t reserved = 0;
    std::uint64_t table_checksum = 0;  ///< XXH3-64 of the section table
    std::uint8_t padding[24] = {};
};
static_assert(sizeof(FileHeader) == 64);

struct SectionEntry {
    std::uint32_t id = 0, version = 1;
    std::uint64_t offset = 0;       ///< from the start of the file, a multiple of 64
    std::uint64_t size = 0;         ///< bytes after decoding
    std::uint64_t stored_size = 0;  ///< bytes in the file
    std::uint32_t codec = 0;        ///< Codec
    std::uint32_t reserved = 0;
    std::uint64_t checksum = 0;  ///< XXH3-64 of the stored bytes
};
static_assert(sizeof(SectionEntry) == 48);

/// Header and table of a file, checked against its size and against each other; section contents
/// are not touched. `file` is used in messages only.
Result<std::vector<SectionEntry>> read_section_table(std::span<const std::byte> bytes,
                                                     const std::string& file);

/// XXH3-64 as used for checksums.
std::uint64_t checksum(std::span<const std::byte> bytes);

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
