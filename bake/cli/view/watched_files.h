#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "bake/cli/view/file_watch.h"
#include "bake/cli/view/view_state.h"

namespace opaline::cli {

/// How often each file of a state has changed while it was watched.
struct FileVersions {
    std::uint64_t file = 0, other = 0, light = 0;
    bool operator==(const FileVersions&) const = default;
};

/// The files of a state, looked at for changes on disk.
class WatchedFiles {
  public:
    const FileVersions& versions() const { return versions_; }

    /// Looks for changes, five times a second at most. Returns how many files changed.
    std::size_t look(const ViewState& state);

  private:
    std::optional<FileWatch> file_, other_, light_;
    FileVersions versions_;
    std::chrono::steady_clock::time_point last_look_ = std::chrono::steady_clock::now();
};

}  // namespace opaline::cli
