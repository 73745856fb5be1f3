#include "formats/opal/section.h"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <memory>
#include <utility>

#include "formats/opal/asset.h"
#include "formats/opal/layout.h"

namespace opaline::formats {
namespace {

constexpr std::byte kZeros[kSectionAlignment] = {};

// Makes of `stored` one part, if that is smaller. Part by part, as a copy of the whole section
// would double the memory of large ones.
void compress(StoredSection& stored, int level) {
    const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(),
                                                                          ZSTD_freeCCtx);
    if (!context) return;
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level);
    ZSTD_CCtx_setPledgedSrcSize(context.get(), stored.entry.size);
    std::vector<std::byte> out;
    const std::size_t step = ZSTD_CStreamOutSize();
    for (std::size_t i = 0; i < stored.parts.size(); ++i) {
        const bool is_last = i + 1 == stored.parts.size();
        ZSTD_inBuffer in{stored.parts[i].data(), stored.parts[i].size(), 0};
        std::size_t unwritten = is_last ? 1 : 0;  // of the frame, which ends with the last part
        while (in.pos < in.size || (is_last && unwritten != 0)) {
            const std::size_t before = out.size();
            out.resize(before + step);
            ZSTD_outBuffer room{out.data() + before, step, 0};
            unwritten = ZSTD_compressStream2(context.get(), &room, &in,
                                             is_last ? ZSTD_e_end : ZSTD_e_continue);
            out.resize(before + room.pos);
            if (ZSTD_isError(unwritten) != 0U || out.size() >= stored.entry.size) return;
        }
    }
    if (stored.entry.size / out.size() >= kMaxCompressionRatio) return;
    stored.compressed = std::move(out);
    stored.entry.codec = static_cast<std::uint32_t>(Codec::zstd);
    stored.parts = {stored.compressed};
}

void sum_up(StoredSection& stored) {
    const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                                XXH3_freeState);
    XXH3_64bits_reset(state.get());
    for (const auto part : stored.parts) {
        XXH3_64bits_update(state.get(), part.data(), part.size());
        stored.entry.stored_size += part.size();
    }
    stored.entry.checksum = XXH3_64bits_digest(state.get());
}

}  // namespace

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
    if (header.endian_mark != kEndianMark) return damaged("header", "the byte-order mark is wrong");
    if (header.version > kOpalVersion) {
        return make_error(ErrorKind::newer_file, file, "header",
                          "format version " + std::to_string(header.version) +
                              " is newer than this program's " + std::to_string(kOpalVersion),
                          "update Opaline");
    }
    if (header.version == 0) return damaged("header", "format version 0 does not exist");
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
    std::ranges::copy(table_bytes, std::as_writable_bytes(std::span(table)).begin());
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

std::size_t padding_to(std::size_t alignment, std::uint64_t size) {
    return static_cast<std::size_t>((alignment - size % alignment) % alignment);
}

std::span<const std::byte> padding_zeros(std::size_t count) {
    assert(count <= sizeof kZeros);
    return {kZeros, count};
}

StoredSection store_arrays(std::uint32_t id, int zstd_level,
                           std::span<const std::span<const std::byte>> arrays) {
    StoredSection stored;
    stored.entry.id = id;
    for (const std::span<const std::byte> array : arrays) {
        const std::size_t padding = padding_to(kArrayAlignment, array.size());
        stored.parts.push_back(array);
        stored.parts.push_back(padding_zeros(padding));
        stored.entry.size += array.size() + padding;
    }
    if (zstd_level != kNotCompressed) compress(stored, zstd_level);
    sum_up(stored);
    return stored;
}

StoredSection store_text(std::uint32_t id, std::span<const char> text) {
    StoredSection stored;
    stored.entry.id = id;
    stored.parts = {std::as_bytes(text)};
    stored.entry.size = text.size();
    sum_up(stored);
    return stored;
}

}  // namespace opaline::formats
