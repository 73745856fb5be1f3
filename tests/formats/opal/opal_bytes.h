#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>
#include <span>
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

}  // namespace opaline::tests
