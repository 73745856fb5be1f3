#pragma once

#include <xmmintrin.h>

namespace opaline::tests {

/// While it lives, this thread may divide by zero and overflow under the preset `traps`: for tests
/// that compute an infinity or NaN on purpose.
class UntrappedFloats {
  public:
    UntrappedFloats() { _mm_setcsr(before_ | _MM_MASK_MASK); }
    ~UntrappedFloats() { _mm_setcsr(before_); }
    UntrappedFloats(const UntrappedFloats&) = delete;
    UntrappedFloats& operator=(const UntrappedFloats&) = delete;

  private:
    unsigned before_ = _mm_getcsr();
};

}  // namespace opaline::tests
