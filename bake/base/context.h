#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace opaline::bake {

/// Progress of a stage. The callback runs on worker threads, one call at a time.
struct Progress {
    std::string_view stage;
    std::uint64_t done = 0, total = 0;
};

/// Surroundings of a long stage: threads, progress, cancellation. None of them changes its result.
struct Context {
    unsigned threads = 0;                              ///< 0: one per core
    std::function<void(const Progress&)> on_progress;  ///< may be empty
    const std::atomic<bool>* cancel = nullptr;         ///< set by SIGINT; may be null
    std::filesystem::path cache;                       ///< folder of the user's; empty: none

    bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
};

}  // namespace opaline::bake
