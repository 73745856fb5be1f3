#pragma once

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

/// Tells the thread sanitizer what oneTBB orders: its library hands work over where the sanitizer
/// sees nothing. Elsewhere these do nothing.
namespace opaline::bake {

#if defined(__SANITIZE_THREAD__)

/// One address for all loops: a step cannot read a loop's own before it has been ordered.
inline char thread_order = 0;
inline void order_after_finished() {
    __tsan_acquire(&thread_order);
}
inline void order_finished() {
    __tsan_release(&thread_order);
}

#else

inline void order_after_finished() {}
inline void order_finished() {}

#endif

/// A step of a loop, from its construction to its end: after all that is finished, and before all
/// that begins when it is finished itself.
class OrderedStep {
  public:
    OrderedStep() { order_after_finished(); }
    ~OrderedStep() { order_finished(); }
    OrderedStep(const OrderedStep&) = delete;
    OrderedStep& operator=(const OrderedStep&) = delete;
};

}  // namespace opaline::bake
