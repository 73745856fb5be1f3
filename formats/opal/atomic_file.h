#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "formats/opal/result.h"

namespace opaline::formats {

/// An output file that appears whole or not at all: bytes go to a temporary file beside the target,
/// `commit` syncs and renames it; without a commit the destructor removes it.
/// A target such as /dev/stdout that is not a regular file is written directly.
class AtomicFile {
  public:
    /// Creates the temporary file, so an unwritable folder is found out before any work is done.
    static Result<AtomicFile> create(const std::filesystem::path& target);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    Status write(std::span<const std::byte> bytes);
    Status write(std::string_view text);
    Status commit();

  private:
    AtomicFile() = default;
    void discard() noexcept;

    std::filesystem::path target_;
    std::string temporary_;  ///< empty when the target is written directly
    int descriptor_ = -1;
};

/// create, write, commit.
Status write_file_atomically(const std::filesystem::path& target, std::string_view bytes);

}  // namespace opaline::formats
