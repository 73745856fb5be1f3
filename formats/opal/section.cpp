#include "formats/opal/section.h"

#include <xxhash.h>

#include <cstring>

#include "formats/opal/asset.h"

namespace opaline::formats {

std::string section_name(std::uint32_t id) {
    std::string name(4, '?');
    for (std::size_t i = 0; i < 4; ++i) {
        const auto letter = static_cast<unsigned char>(id >> (8 * i));
        if (letter >= 0x20 && letter < 0x7f) {
            name[i] = static_cast<char>(letter);
        }
    }
    return name;
}

std::uint64_t checksum(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

Result<std::vector<SectionEntry>> read_section_table(std::span<const std::byte> bytes,
                                                     const std::string& file) {
    const auto damaged = [&](std::string where, std::string fault) {
        return make_error(ErrorKind::bad_input, file, std::move(where), std::move(fault),
                          "the file is damaged: bake it again, or copy it again");
    };
    FileHeader header;
    if (bytes.size() < sizeof header) {
        return damaged("header", "the file has " + std::to_string(bytes.size()) +
                                     " bytes, fewer than a header's 64");
    }
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.magic != kOpalMagic) {
        return make_error(ErrorKind::bad_input, file, "header",
                          "does not begin with the .opal magic bytes",
                          "give a file written by `opaline bake`");
    }
    if (header.endian_mark != kEndianMark) {
        return damaged("header", "the byte-order mark is wrong");
    }
    if (header.version > kOpalVersion) {
        return make_error(ErrorKind::newer_file, file, "header",
                          "format version " + std::to_string(header.version) +
                              " is newer than this program's " + std::to_string(kOpalVersion),
                          "update Opaline");
    }
    if (header.version == 0) {
        return damaged("header", "format version 0 does not exist");
    }
    if (header.file_size != bytes.size()) {
        return damaged("header", "the file should have " + std::to_string(header.file_size) +
                                     " bytes but has " + std::to_string(bytes.size()));
    }
    const std::uint64_t table_size = std::uint64_t{header.section_count} * sizeof(SectionEntry);
    if (header.section_count > kMaxSections || sizeof header + table_size > bytes.size()) {
        return damaged("header",
                       std::to_string(header.section_count) + " sections do not fit into the file");
    }
    const auto table_bytes = bytes.subspan(sizeof header, static_cast<std::size_t>(table_size));
    if (checksum(table_bytes) != header.table_checksum) {
        return damaged("section table", "its checksum does not match");
    }
    std::vector<SectionEntry> table(header.section_count);
    std::memcpy(table.data(), table_bytes.data(), table_bytes.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        const SectionEntry& entry = table[i];
        const std::string where = "section " + section_name(entry.id);
        if (entry.offset % kSectionAlignment != 0 || entry.offset > bytes.size() ||
            entry.stored_size > bytes.size() - entry.offset) {
            return damaged(where, "it lies outside the file");
        }
        for (std::size_t j = 0; j < i; ++j) {
            if (table[j].id == entry.id) {
                return damaged(where, "it stands twice in the section table");
            }
        }
    }
    return table;
}

}  // namespace opaline::formats
