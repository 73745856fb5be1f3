// Embree divides by zero in every traversal, by design. With the preset `traps` calls to it go
// through these functions (the linker's --wrap, tests/CMakeLists.txt), untrapped: single steps over
// each such division would take a hundred times as long. Weak, as not every test has Embree.

#include "tests/support/float_traps.h"

using opaline::tests::UntrappedFloats;

#define OPALINE_UNTRAPPED(name)                                          \
    extern "C" {                                                         \
    [[gnu::weak]] bool __real_##name(void*, void*, void*, void*, void*); \
    bool __wrap_##name(void* a, void* b, void* c, void* d, void* e);     \
    bool __wrap_##name(void* a, void* b, void* c, void* d, void* e) {    \
        const UntrappedFloats untrapped;                                 \
        return __real_##name(a, b, c, d, e);                             \
    }                                                                    \
    }

// All arguments are addresses, five at most, and what follows them is ignored, as is what is
// returned but by rtcPointQuery.
OPALINE_UNTRAPPED(rtcIntersect1)
OPALINE_UNTRAPPED(rtcIntersect8)
OPALINE_UNTRAPPED(rtcIntersect16)
OPALINE_UNTRAPPED(rtcOccluded1)
OPALINE_UNTRAPPED(rtcOccluded8)
OPALINE_UNTRAPPED(rtcOccluded16)
OPALINE_UNTRAPPED(rtcPointQuery)
