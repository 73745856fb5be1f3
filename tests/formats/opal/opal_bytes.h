#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <functional>
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
inline std::vector<std::byte> encode(const formats::AssetView& asset) {
    const TemporaryFolder folder;
    auto file = formats::AtomicFile::create(folder / "a.opal");
    EXPECT_TRUE(file);
    EXPECT_TRUE(formats::write_opal(asset, std::move(*file)));
    auto mapped = formats::FileBytes::open(folder / "a.opal");
    EXPECT_TRUE(mapped);
    return {mapped->bytes().begin(), mapped->bytes().end()};
}
inline std::vector<std::byte> encode(const formats::Asset& asset) {
    return encode(asset.view());
}

/// An asset that was written and read again, which must succeed.
struct StoredAsset {
    explicit StoredAsset(const formats::Asset& asset)
        : stored(encode(asset)),
          loaded(formats::read_opal(stored.bytes(), "a.opal", formats::Checks::full)) {
        EXPECT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
        if (!loaded) loaded = formats::LoadedAsset{};
    }
    const formats::AssetView& view() const { return loaded->view; }
    /// Of a section; 0: it is not there.
    std::uint32_t version_of(std::uint32_t id) const {
        for (const formats::SectionEntry& section : loaded->sections) {
            if (section.id == id) return section.version;
        }
        return 0;
    }
    /// Whether an array of the view lies in the file.
    bool holds(auto span) {
        const auto bytes = std::as_bytes(span), all = std::span<const std::byte>(stored.bytes());
        return bytes.data() >= all.data() && bytes.data() + bytes.size() <= all.data() + all.size();
    }

    AlignedBytes stored;
    formats::Result<formats::LoadedAsset> loaded;
};

template <class A, class B>
void expect_same_bytes(const A& a, const B& b) {
    ASSERT_EQ(std::size(a), std::size(b));
    if (std::size(a) > 0) {
        EXPECT_EQ(std::memcmp(std::data(a), std::data(b), std::size(a) * sizeof(*std::data(a))), 0);
    }
}

inline void expect_same_rows(const formats::SparseRowsView& a, const formats::SparseRowsView& b) {
    EXPECT_EQ(a.cubemap_size, b.cubemap_size);
    EXPECT_EQ(a.code_bits, b.code_bits);
    expect_same_bytes(a.row_offset, b.row_offset);
    expect_same_bytes(a.average_scale, b.average_scale);
    expect_same_bytes(a.detail_scale, b.detail_scale);
    expect_same_bytes(a.average_code, b.average_code);
    expect_same_bytes(a.index16, b.index16);
    expect_same_bytes(a.index32, b.index32);
    expect_same_bytes(a.code8, b.code8);
    expect_same_bytes(a.code16, b.code16);
}

/// "where: fault" of the file that an asset is written to, empty where it passes the checks.
inline std::string fault_of(const formats::Asset& asset, formats::Checks checks) {
    AlignedBytes stored(encode(asset));
    const auto loaded = formats::read_opal(stored.bytes(), "a.opal", checks);
    if (loaded) return {};
    const auto& diagnostic = loaded.error().diagnostics.front();
    return diagnostic.where + ": " + diagnostic.fault;
}

/// That of the asset after change(Asset&).
template <class Change>
std::string fault_after(formats::Asset asset, Change change,
                        formats::Checks checks = formats::Checks::structure) {
    change(asset);
    return fault_of(asset, checks);
}

/// A change that makes an asset impossible, and part of the message.
struct Impossible {
    std::function<void(formats::Asset&)> change;
    const char* fault;
};
/// Expects that each of them is refused, in the section named.
inline void expect_refused(const formats::Asset& asset, const std::string& section,
                           const std::vector<Impossible>& cases,
                           formats::Checks checks = formats::Checks::structure) {
    EXPECT_EQ(fault_of(asset, checks), "");
    for (const auto& [change, fault] : cases) {
        EXPECT_THAT(
            fault_after(asset, change, checks),
            testing::AllOf(testing::StartsWith("section " + section), testing::HasSubstr(fault)));
    }
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
