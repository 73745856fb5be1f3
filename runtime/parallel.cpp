#include "runtime/parallel.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>

namespace opaline::runtime {

namespace {

ThreadPool host_pool;

}  // namespace

void use_thread_pool(ThreadPool pool) {
    host_pool = pool;
}

void run_ranges(std::uint32_t count, std::uint32_t grain, unsigned threads,
                void (*work)(const void*, std::uint32_t, std::uint32_t), const void* context) {
    const std::uint32_t ranges = count / grain + (count % grain != 0 ? 1 : 0);
    const unsigned workers = std::min(resolve_threads(threads), std::max(ranges, 1u));
    std::atomic<std::uint32_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_guard;
    const auto run = [&] {
        try {
            for (std::uint32_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < ranges;) {
                work(context, i * grain, std::min(count - i * grain, grain) + i * grain);
            }
        } catch (...) {
            const std::lock_guard lock(failure_guard);
            failure = std::current_exception();
        }
    };
    if (workers > 1 && host_pool.run != nullptr) {
        host_pool.run(
            host_pool.user, workers,
            [](void* own, std::uint32_t) { (*static_cast<decltype(run)*>(own))(); },
            const_cast<void*>(static_cast<const void*>(&run)));
        if (failure) std::rethrow_exception(failure);
        return;
    }
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
