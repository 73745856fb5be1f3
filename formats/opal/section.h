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
inline constexpr std::uint32_t kNormSection = section_id("NORM");
inline constexpr std::uint32_t kTranSection = section_id("TRAN");
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

}  // namespace opaline::formats
