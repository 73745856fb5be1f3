#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "formats/opal/result.h"

namespace opaline::formats {

/// A whole file in memory, aligned to 64 bytes. Read, not mapped: a mapped file that somebody
/// shortens meanwhile ends the program.
class FileBytes {
  public:
    /// Errors: bad_input (not there, not a regular file, became shorter meanwhile), resource.
    static Result<FileBytes> open(const std::filesystem::path& path);

    std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

  private:
    struct Delete {
        void operator()(std::byte* data) const;
    };
    FileBytes() = default;
    std::unique_ptr<std::byte, Delete> data_;
    std::size_t size_ = 0;
};

}  // namespace opaline::formats
