#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "bake/cli/view/file_watch.h"
#include "bake/cli/view/shown_file.h"
#include "bake/cli/view/view_state.h"
#include "formats/opal/result.h"
#include "runtime/picture/picture.h"

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

/// What to draw. `serial` grows with every request; a version with each reading of a file that is
/// asked for, though its name stays.
struct DrawRequest {
    ViewState state;
    std::uint64_t serial = 0;
    FileVersions version;
    bool is_exact = false;  ///< the last picture has the very samples of `render`
};

/// One side of a picture.
struct DrawnSide {
    runtime::Picture picture;  ///< empty: none
    FileFacts facts;
    ViewSeconds seconds;
    double coefficient_error = 0;
};

/// What a request gave.
struct DrawnView {
    std::uint64_t serial = 0;
    bool is_final = false;  ///< in full quality: the samples of `opaline render`
    std::optional<Viewpoint> viewpoint;
    float exposure = 0;  ///< that the picture of `file` asks for [EV]
    DrawnSide file, other;
    std::optional<formats::Error> error;  ///< then nothing was drawn
};

/// Draws on a thread of its own, so that the window answers while a picture takes its time, and so
/// that the renderer's OpenGL context meets no other one on its thread. Of requests only the newest
/// is drawn: first in a quality that takes some 40 ms, then, while no other request comes, in
/// better ones, 120 ms after each other, up to the full one.
class DrawThread {
  public:
    DrawThread();
    ~DrawThread();
    DrawThread(const DrawThread&) = delete;
    DrawThread& operator=(const DrawThread&) = delete;

    void request(DrawRequest request);
    /// What was drawn since the last call, the newest only; or null.
    std::shared_ptr<const DrawnView> take();

  private:
    void run();
    std::mutex mutex_;
    std::condition_variable wake_;
    std::optional<DrawRequest> request_;
    std::shared_ptr<const DrawnView> drawn_;
    bool ends_ = false;
    std::atomic<bool> stop_ = false;  ///< another request came, or the end
    std::thread thread_;
};

}  // namespace opaline::cli
