#include "bake/lab/sweep/time_limit.h"

#include <chrono>

#include "bake/base/stage_log.h"

namespace opaline::bake {

TimeLimit::TimeLimit(double seconds, const std::atomic<bool>* outer)
    : watch_([this, seconds, outer, start = Clock::now()](const std::stop_token& stop) {
          constexpr std::chrono::milliseconds kLook{10};
          std::unique_lock lock(mutex_);
          while (!stop.stop_requested()) {
              if (seconds_since(start) >= seconds || (outer != nullptr && outer->load())) {
                  over_.store(true);
                  return;
              }
              wake_.wait_for(lock, stop, kLook, [] { return false; });
          }
      }) {}

}  // namespace opaline::bake
