#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

#include "bake/base/thread_order.h"

namespace opaline::bake {

/// Runs body(i) for every i in [0, count), on the threads of the arena it is called in, in no
/// order: bodies write to places of their own.
template <class Body>
void for_each_index(std::size_t count, const Body& body) {
    order_finished();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          const OrderedStep step;
                          for (std::size_t i = range.begin(); i != range.end(); ++i) {
                              body(i);
                          }
                      });
    order_after_finished();
}

}  // namespace opaline::bake
