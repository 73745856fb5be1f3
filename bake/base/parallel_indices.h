#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace opaline::bake {

/// Runs body(i) for every i in [0, count), on the threads of the arena it is called in, in no
/// order: bodies write to places of their own.
template <class Body>
void for_each_index(std::size_t count, const Body& body) {
    // As in ordered_parallel.h: the thread sanitizer sees what comes before and after all bodies.
    std::atomic<std::uint64_t> steps{1};
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          steps.fetch_add(1, std::memory_order_acq_rel);
                          for (std::size_t i = range.begin(); i != range.end(); ++i) {
                              body(i);
                          }
                          steps.fetch_add(1, std::memory_order_acq_rel);
                      });
    steps.fetch_add(1, std::memory_order_acq_rel);
}

}  // namespace opaline::bake
