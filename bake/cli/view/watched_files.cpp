#include "bake/cli/view/watched_files.h"

#include <string>

#include "bake/environment/builtin_environment.h"

namespace opaline::cli {
namespace {

// How often it changed since the last look; `path` empty: there is none.
std::uint64_t changes_of(std::optional<FileWatch>& watch, const std::string& path) {
    if (path.empty()) {
        watch.reset();
        return 0;
    }
    if (!watch || watch->path() != path) watch.emplace(path);
    return watch->look() ? 1 : 0;
}

}  // namespace

std::size_t WatchedFiles::look(const ViewState& state) {
    constexpr std::chrono::milliseconds kPause{200};
    const auto now = std::chrono::steady_clock::now();
    if (now - last_look_ < kPause) return 0;
    last_look_ = now;
    const std::uint64_t file = changes_of(file_, state.file);
    const std::uint64_t other = changes_of(other_, state.other);
    const std::uint64_t light =
        changes_of(light_, bake::is_builtin(state.light) ? std::string() : state.light);
    versions_ = {versions_.file + file, versions_.other + other, versions_.light + light};
    return file + other + light;
}

}  // namespace opaline::cli
