#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace opaline::runtime {

inline constexpr unsigned kMaxThreads = 256;

/// 0 means one thread per core.
inline unsigned resolve_threads(unsigned threads) {
    return std::clamp(threads != 0 ? threads : std::thread::hardware_concurrency(), 1u,
                      kMaxThreads);
}

/// Calls work(begin, end) for consecutive ranges of at most `grain` that cover [0, count), on up to
/// `threads` threads. `work` must not depend on which ranges it is given. If the system
/// refuses a thread, the others do its share; if `work` throws (memory), one of its exceptions is
/// thrown again here.
template <class Work>
void for_ranges(std::uint32_t count, std::uint32_t grain, unsigned threads, const Work& work) {
    const std::uint32_t ranges = count / grain + (count % grain != 0 ? 1 : 0);
    const unsigned workers = std::min(resolve_threads(threads), std::max(ranges, 1u));
    std::atomic<std::uint32_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_guard;
    const auto run = [&] {
        try {
            for (std::uint32_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < ranges;) {
                work(i * grain, std::min(count - i * grain, grain) + i * grain);
            }
        } catch (...) {
            const std::lock_guard lock(failure_guard);
            failure = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    if (workers > 1) {
        others.reserve(workers - 1);
        try {
            while (others.size() + 1 < workers) {
                others.emplace_back(run);
            }
        } catch (const std::system_error&) {
        }
    }
    run();
    for (std::thread& other : others) {
        other.join();
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
}

}  // namespace opaline::runtime
