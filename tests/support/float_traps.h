#pragma once

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace opaline::tests {

/// While it lives, this thread and those that it starts may divide by zero and overflow under the
/// preset `traps`: for tests that give or compute an infinity or NaN on purpose. Otherwise nothing.
class UntrappedFloats {
  public:
    UntrappedFloats(const UntrappedFloats&) = delete;
    UntrappedFloats& operator=(const UntrappedFloats&) = delete;
#if defined(__x86_64__)
    UntrappedFloats() {
        _mm_setcsr(before_ | _MM_MASK_MASK);
    }
    ~UntrappedFloats() {
        _mm_setcsr(before_);
    }

  private:
    unsigned before_ = _mm_getcsr();
#else
    UntrappedFloats() {}
    ~UntrappedFloats() {}
#endif
};

}  // namespace opaline::tests
