#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/opal/file_bytes.h"
#include "formats/opal/read_opal.h"
#include "formats/opal/write_opal.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {

/// Bytes at an address aligned like a mapped file's, with nothing readable behind them under the
/// address sanitizer.
class AlignedBytes {
  public:
    explicit AlignedBytes(std::span<const std::byte> bytes)
        : size_(bytes.size()),
          data_(static_cast<std::byte*>(
              ::operator new(std::max<std::size_t>(size_, 1), std::align_val_t(64)))) {
        std::memcpy(data_, bytes.data(), size_);
    }
    AlignedBytes(const AlignedBytes&) = delete;
    AlignedBytes& operator=(const AlignedBytes&) = delete;
    ~AlignedBytes() { ::operator delete(data_, std::align_val_t(64)); }
    std::span<std::byte> bytes() { return {data_, size_}; }

  private:
    std::size_t size_;
    std::byte* data_;
};

/// The file that an asset is written to.
inline std::vector<std::byte> encode(const formats::Asset& asset) {
    const TemporaryFolder folder;
    auto file = formats::AtomicFile::create(folder / "a.opal");
    EXPECT_TRUE(file);
    EXPECT_TRUE(formats::write_opal(asset.view(), std::move(*file)));
    auto mapped = formats::FileBytes::open(folder / "a.opal");
    EXPECT_TRUE(mapped);
    return {mapped->bytes().begin(), mapped->bytes().end()};
}

template <class T>
void expect_same_bytes(std::span<const T> a, std::span<const T> b) {
    ASSERT_EQ(a.size(), b.size());
    if (!a.empty()) {
        EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0);
    }
}

/// "where: fault" of the file that an asset is written to, empty where it passes the checks.
inline std::string fault_of(const formats::Asset& asset, formats::Checks checks) {
    AlignedBytes stored(encode(asset));
    const auto loaded = formats::read_opal(stored.bytes(), "a.opal", checks);
    if (loaded) return {};
    const auto& diagnostic = loaded.error().diagnostics.front();
    return diagnostic.where + ": " + diagnostic.fault;
}

/// The section of a table with this id. Precondition: it is there.
inline const formats::SectionEntry& section_of(std::span<const formats::SectionEntry> table,
                                               std::uint32_t id) {
    return *std::find_if(table.begin(), table.end(), [id](const auto& s) { return s.id == id; });
}

/// Makes the checksums of a section and of the section table right again, as a hostile writer does.
/// Precondition: header and table are whole.
inline void repair_checksums(std::span<std::byte> file, std::uint32_t id) {
    formats::FileHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    std::vector<formats::SectionEntry> table(header.section_count);
    const auto stored = file.subspan(sizeof header, table.size() * sizeof table[0]);
    std::memcpy(table.data(), stored.data(), stored.size());
    for (formats::SectionEntry& section : table) {
        if (section.id != id) continue;
        section.checksum = formats::checksum(file.subspan(section.offset, section.stored_size));
    }
    std::memcpy(stored.data(), table.data(), stored.size());
    header.table_checksum = formats::checksum(stored);
    std::memcpy(file.data(), &header, sizeof header);
}

}  // namespace opaline::tests
