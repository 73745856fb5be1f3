#pragma once

#include <time.h>

namespace opaline::bake {

/// CPU time of the calling thread, on which other processes have little influence.
class Stopwatch {
  public:
    Stopwatch() : start_(now()) {}
    void restart() { start_ = now(); }
    /// Since the start [s], at least 1 ns, so that rates stay finite.
    double seconds() const {
        const double passed = now() - start_;
        return passed > 1e-9 ? passed : 1e-9;
    }

  private:
    static double now() {
        timespec t{};
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }
    double start_;
};

}  // namespace opaline::bake
