#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace opaline::bake {

/// A flag for Context::cancel that is set once so many seconds are over, or once `outer`, which may
/// be null, is set.
class TimeLimit {
  public:
    TimeLimit(double seconds, const std::atomic<bool>* outer);

    const std::atomic<bool>* flag() const { return &over_; }

  private:
    std::atomic<bool> over_ = false;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread watch_;  // last: it reads the others
};

}  // namespace opaline::bake
