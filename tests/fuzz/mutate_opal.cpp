#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <random>

#include "formats/opal/section.h"
#include "tests/fuzz/mutators.h"

namespace opaline::fuzz {
namespace {

using formats::FileHeader;
using formats::SectionEntry;

struct Part {
    SectionEntry entry;
    Blob content;  ///< decoded
};

std::optional<std::vector<Part>> take_apart(const Blob& file) {
    const auto bytes = std::as_bytes(std::span(file));
    const auto table = formats::read_section_table(bytes, "x");
    if (!table) return {};
    std::vector<Part> parts;
    for (const SectionEntry& entry : *table) {
        Part part{entry, Blob(file.begin() + static_cast<std::ptrdiff_t>(entry.offset),
                              file.begin() +
                                  static_cast<std::ptrdiff_t>(entry.offset + entry.stored_size))};
        if (entry.codec == 1) {
            Blob decoded(std::min<std::size_t>(entry.size, std::size_t{1} << 20));
            const std::size_t size = ZSTD_decompress(decoded.data(), decoded.size(),
                                                     part.content.data(), part.content.size());
            if (ZSTD_isError(size) != 0U) return {};
            decoded.resize(size);
            part.content = std::move(decoded);
            part.entry.codec = 0;
        }
        part.entry.size = part.entry.stored_size = part.content.size();
        parts.push_back(std::move(part));
    }
    return parts;
}

void put(Blob& file, std::size_t at, const void* from, std::size_t size) {
    file.resize(std::max(file.size(), at + size));
    if (size > 0) std::memcpy(file.data() + at, from, size);
}

// The file, its checksums right. What an entry says of sizes, id, version and codec is left.
Blob put_together(std::vector<Part>& parts) {
    FileHeader header;
    header.version = 1;
    header.section_count = static_cast<std::uint32_t>(parts.size());
    Blob file(sizeof header + parts.size() * sizeof(SectionEntry));
    std::vector<SectionEntry> table;
    for (Part& part : parts) {
        file.resize(file.size() + formats::padding_to(formats::kSectionAlignment, file.size()));
        part.entry.offset = file.size();
        part.entry.checksum = formats::checksum(std::as_bytes(std::span(part.content)));
        file.insert(file.end(), part.content.begin(), part.content.end());
        table.push_back(part.entry);
    }
    header.file_size = file.size();
    header.table_checksum = formats::checksum(std::as_bytes(std::span(table)));
    put(file, 0, &header, sizeof header);
    put(file, sizeof header, table.data(), table.size() * sizeof table[0]);
    return file;
}

void compress(Part& part) {
    Blob packed(ZSTD_compressBound(part.content.size()));
    packed.resize(
        ZSTD_compress(packed.data(), packed.size(), part.content.data(), part.content.size(), 1));
    part.content = std::move(packed);
    part.entry.stored_size = part.content.size();
    part.entry.codec = 1;
}

void change_content(Part& part, std::minstd_rand& random) {
    const std::size_t size = part.content.size();
    part.content = mutate_bytes(part.content, random() % 4 == 0 ? size + 256 : size);
    if (random() % 8 != 0) part.content.resize(size);
    part.entry.size = part.entry.stored_size = part.content.size();
    if (random() % 16 == 0) compress(part);
}

void change_entry(Part& part, std::minstd_rand& random) {
    switch (random() % 4) {
        case 0:
            part.entry.version = random() % 7;
            break;
        case 1:
            part.entry.codec = random() % 3;
            break;
        case 2:
            part.entry.size = random() % 2 == 0 ? part.entry.size * 2 : random();
            break;
        default:
            part.entry.id ^= 1u << random() % 32;
    }
}

}  // namespace

Blob mutate_opal(const Blob& bytes, unsigned seed, std::size_t most) {
    std::minstd_rand random(seed);
    auto parts = take_apart(bytes);
    if (!parts || parts->empty() || random() % 32 == 0) return mutate_bytes(bytes, most);
    const std::size_t chosen = random() % parts->size();
    switch (random() % 16) {
        case 0:
            change_entry((*parts)[chosen], random);
            break;
        case 1:
            parts->erase(parts->begin() + static_cast<std::ptrdiff_t>(chosen));
            break;
        case 2:
            std::swap((*parts)[chosen], (*parts)[random() % parts->size()]);
            break;
        default:
            change_content((*parts)[chosen], random);
    }
    Blob file = put_together(*parts);
    return file.size() <= most ? file : Blob();
}

}  // namespace opaline::fuzz
