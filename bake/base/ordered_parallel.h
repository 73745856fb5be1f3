#pragma once

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>

#include "bake/base/context.h"

namespace opaline::bake {

/// The number of threads a context asks for.
inline unsigned thread_count(const Context& context) {
    return context.threads != 0 ? context.threads
                                : std::max(1u, std::thread::hardware_concurrency());
}

/// Half-open range of receivers.
struct Range {
    std::size_t begin = 0, end = 0;
};

/// Cuts [0, count) into blocks, runs `compute(Range)` on all threads and hands each result to
/// `consume(Range, result&&)` one at a time and in index order, so the consumer's output does not
/// depend on the number of threads. Only a few blocks per thread are alive at once. Stops early,
/// after consuming what was in flight, once the context is cancelled.
template <class Compute, class Consume>
void for_each_block_in_order(std::size_t count, std::size_t block, const Context& context,
                             Compute&& compute, Consume&& consume) {
    const unsigned threads = thread_count(context);
    tbb::task_arena arena(static_cast<int>(threads));
    using Item = decltype(compute(Range{}));
    struct Job {
        Range range;
        Item item;
    };
    // TBB hands work over inside its library, where the thread sanitizer sees nothing. Jobs are
    // handed over by pointer, and every step begins and ends with this, so that it sees the order
    // of steps that follow each other, and still a race of steps that do not.
    std::atomic<std::uint64_t> steps{0};
    const auto in_order = [&](auto&& step) {
        steps.fetch_add(1, std::memory_order_acq_rel);
        auto* const result = step();
        steps.fetch_add(1, std::memory_order_acq_rel);
        return result;
    };
    std::size_t next = 0;
    arena.execute([&] {
        tbb::parallel_pipeline(
            std::size_t{threads} * 4,
            tbb::make_filter<void, Range*>(tbb::filter_mode::serial_in_order, [&](tbb::flow_control&
                                                                                      control) {
                return in_order([&]() -> Range* {
                    if (next >= count || context.cancelled()) {
                        control.stop();
                        return nullptr;
                    }
                    auto range = std::make_unique<Range>(next, std::min(count, next + block));
                    next = range->end;
                    return range.release();
                });
            }) & tbb::make_filter<Range*, Job*>(tbb::filter_mode::parallel, [&](Range* given) {
                return in_order([&] {
                    const std::unique_ptr<Range> range(given);
                    return new Job{*range, compute(*range)};
                });
            }) & tbb::make_filter<Job*, void>(tbb::filter_mode::serial_in_order, [&](Job* given) {
                in_order([&]() -> Job* {
                    const std::unique_ptr<Job> job(given);
                    consume(job->range, std::move(job->item));
                    return nullptr;
                });
            }));
    });
}

}  // namespace opaline::bake
