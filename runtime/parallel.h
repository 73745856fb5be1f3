#pragma once

#include <algorithm>
#include <cstdint>
#include <thread>
#include <vector>

namespace opaline::runtime {

inline constexpr unsigned kMaxThreads = 256;

/// A host's thread pool: calls task(context, i) for each i < count, on any threads and in any
/// order, and returns when all calls have.
struct ThreadPool {
    void (*run)(void* user, std::uint32_t count, void (*task)(void* context, std::uint32_t index),
                void* context) = nullptr;
    void* user = nullptr;
};

/// Runs on this pool what otherwise starts threads; without a function, threads are started again.
/// Not while other work runs.
void use_thread_pool(ThreadPool pool);

/// 0 means one thread per core.
inline unsigned resolve_threads(unsigned threads) {
    return std::clamp(threads != 0 ? threads : std::thread::hardware_concurrency(), 1u,
                      kMaxThreads);
}

/// for_ranges of work(context, begin, end): one piece of code for all kinds of work, because a
/// loop on threads takes a kilobyte of it.
void run_ranges(std::uint32_t count, std::uint32_t grain, unsigned threads,
                void (*work)(const void*, std::uint32_t, std::uint32_t), const void* context);

/// Calls work(begin, end) for consecutive ranges of at most `grain` that cover [0, count), on up to
/// `threads` threads. `work` must not depend on which ranges it is given. If the system
/// refuses a thread, the others do its share; if `work` throws (memory), one of its exceptions is
/// thrown again here.
template <class Work>
void for_ranges(std::uint32_t count, std::uint32_t grain, unsigned threads, const Work& work) {
    run_ranges(
        count, grain, threads,
        [](const void* context, std::uint32_t begin, std::uint32_t end) {
            (*static_cast<const Work*>(context))(begin, end);
        },
        &work);
}

}  // namespace opaline::runtime
