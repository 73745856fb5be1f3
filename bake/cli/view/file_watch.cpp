#include "bake/cli/view/file_watch.h"

#include <sys/stat.h>

#include <utility>

namespace opaline::cli {

FileWatch::FileWatch(std::filesystem::path path)
    : path_(std::move(path)), known_(stamp_of(path_)), seen_(known_) {}

FileWatch::Stamp FileWatch::stamp_of(const std::filesystem::path& path) {
    struct stat found = {};
    if (::stat(path.c_str(), &found) != 0) return {};
    return {found.st_mtim.tv_sec, found.st_mtim.tv_nsec, static_cast<std::uint64_t>(found.st_size),
            found.st_ino, true};
}

bool FileWatch::look() {
    const Stamp now = stamp_of(path_);
    const bool rests = now == seen_;
    seen_ = now;
    if (!now.exists || !rests || now == known_) return false;
    known_ = now;
    return true;
}

}  // namespace opaline::cli
