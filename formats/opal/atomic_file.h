#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "formats/opal/result.h"

namespace opaline::formats {

/// Where bytes wait for the commit. `unnamed`: in a file without a name (O_TMPFILE), which the
/// kernel removes however the process ends; where the file system has none, as `named`. `named`: in
/// a file `.opaline-XXXXXX` beside the target, which outlives a killed process; the next output to
/// that folder removes it.
enum class Temporary { unnamed, named };

/// An output file that appears whole or not at all: bytes go to a temporary file, `commit` syncs it
/// and gives it the target's name; without a commit the destructor removes it.
/// Links are followed. A target that is not a regular file, and those that are opened by
/// descriptor, such as /dev/stdout, are written directly.
class AtomicFile {
  public:
    /// Creates the temporary file, so an unwritable folder is found out before any work is done.
    static Result<AtomicFile> create(const std::filesystem::path& target,
                                     Temporary temporary = Temporary::unnamed);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    Status write(std::span<const std::byte> bytes);
    Status write(std::string_view text);
    std::uint64_t bytes_written() const { return written_; }

    /// Puts what was written on the disk, still without the target's name. Of several files that
    /// belong together, sync all, then commit: what is likely to fail has then been done.
    Status sync();
    Status commit();

  private:
    AtomicFile() = default;
    void discard() noexcept;
    Status publish();

    std::filesystem::path target_;       ///< as given, for messages
    std::filesystem::path destination_;  ///< links followed; empty: written directly
    std::string temporary_;              ///< its path; empty: it has no name
    int descriptor_ = -1;
    std::uint64_t written_ = 0;
};

/// create, write, commit.
Status write_file_atomically(const std::filesystem::path& target, std::string_view bytes);

/// The absolute path of the file that writing to `path` creates or replaces: links are followed,
/// those to files that do not exist too.
std::filesystem::path resolve_links(const std::filesystem::path& path);

}  // namespace opaline::formats
