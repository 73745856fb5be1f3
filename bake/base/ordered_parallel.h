#pragma once

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "bake/base/context.h"
#include "bake/base/thread_order.h"

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
    struct Slot {
        Range range;
        std::optional<Item> item;
    };
    // A ring: blocks leave in order and at most as many as there are slots are alive, so the block
    // that stood in a slot has left when the next one takes it.
    std::vector<Slot> slots(std::size_t{threads} * 4);
    std::size_t next = 0, slot = 0;
    const auto take = tbb::make_filter<void, Slot*>(
        tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) -> Slot* {
            const OrderedStep step;
            if (next >= count || context.cancelled()) {
                control.stop();
                return nullptr;
            }
            Slot& given = slots[slot];
            slot = (slot + 1) % slots.size();
            given.range = {next, std::min(count, next + block)};
            next = given.range.end;
            return &given;
        });
    const auto work = tbb::make_filter<Slot*, Slot*>(tbb::filter_mode::parallel, [&](Slot* given) {
        const OrderedStep step;
        given->item.emplace(compute(given->range));
        return given;
    });
    const auto leave =
        tbb::make_filter<Slot*, void>(tbb::filter_mode::serial_in_order, [&](Slot* given) {
            const OrderedStep step;
            consume(given->range, *std::move(given->item));
            given->item.reset();
        });
    order_finished();
    arena.execute([&] { tbb::parallel_pipeline(slots.size(), take & work & leave); });
    order_after_finished();
}

}  // namespace opaline::bake
