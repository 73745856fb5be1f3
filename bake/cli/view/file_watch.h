#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace opaline::cli {

/// Notices that a file was replaced or written again: by its time, size and inode, which have to
/// stay for two looks, so that a file that is being written is left alone.
class FileWatch {
  public:
    explicit FileWatch(std::filesystem::path path);

    /// Whether the file changed since it was made or last said so. A file that is not there has not
    /// changed.
    bool look();
    const std::filesystem::path& path() const { return path_; }

  private:
    struct Stamp {
        std::int64_t seconds = 0, nanoseconds = 0;
        std::uint64_t size = 0, inode = 0;
        bool exists = false;
        bool operator==(const Stamp&) const = default;
    };
    static Stamp stamp_of(const std::filesystem::path& path);
    std::filesystem::path path_;
    Stamp known_, seen_;
};

}  // namespace opaline::cli
