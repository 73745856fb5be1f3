#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/opal/section.h"

namespace opaline::formats {

/// Where decoded sections are kept: a host's allocator, or, with no functions, operator new. It may
/// give no memory (nullptr), which is reported. `alignment` is a power of two.
struct Memory {
    void* (*allocate)(void* user, std::size_t size, std::size_t alignment) = nullptr;
    void (*release)(void* user, void* memory, std::size_t size, std::size_t alignment) = nullptr;
    void* user = nullptr;
};

/// Bytes that go back to where they came from.
class DecodedBytes {
  public:
    /// `empty` where there is no memory.
    DecodedBytes(const Memory& memory, std::size_t size);
    DecodedBytes(DecodedBytes&& other) noexcept;
    DecodedBytes& operator=(DecodedBytes&&) = delete;
    ~DecodedBytes();

    std::byte* data() const { return data_; }
    bool empty() const { return data_ == nullptr; }

  private:
    Memory memory_;
    std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

/// An asset read in place. `view` points into the bytes given to `read_opal`, which must outlive
/// it, and into `decoded` for the sections that were compressed.
struct LoadedAsset {
    AssetView view;
    std::vector<SectionEntry> sections;
    std::vector<DecodedBytes> decoded;
};

enum class Checks {
    sizes,  ///< that sections lie inside the file and arrays inside sections: for trusted files,
            ///< since offsets and indices inside of arrays may then point anywhere
    structure,  ///< every count, offset and index that memory safety depends on
    full        ///< also checksums, finite numbers and value ranges: `opaline verify`
};

/// Reads an `.opal` file from memory; `bytes` 64-byte aligned. Untrusted input is safe: every count
/// is checked against the size of its section before use, and nothing is allocated on an unchecked
/// size. Errors: bad_input (what is damaged, and where), newer_file (written by a later version).
/// Unknown sections are skipped.
Result<LoadedAsset> read_opal(std::span<const std::byte> bytes, const std::string& file,
                              Checks checks = Checks::structure, const Memory& memory = {});

}  // namespace opaline::formats
