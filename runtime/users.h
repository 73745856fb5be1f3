#pragma once

#include <atomic>

namespace opaline::runtime {

/// Who uses a handle of the C interface: any number of readers, or one writer. Nobody waits: a
/// caller that comes at the wrong time is told so, and nothing races.
class Users {
  public:
    bool enter_as_reader() {
        int now = count_.load(std::memory_order_relaxed);
        while (now >= 0) {
            if (count_.compare_exchange_weak(now, now + 1, std::memory_order_acquire,
                                             std::memory_order_relaxed)) {
                return true;
            }
        }
        return false;
    }
    void leave_as_reader() { count_.fetch_sub(1, std::memory_order_release); }

    bool enter_as_writer() {
        int nobody = 0;
        return count_.compare_exchange_strong(nobody, kWriter, std::memory_order_acquire,
                                              std::memory_order_relaxed);
    }
    void leave_as_writer() { count_.store(0, std::memory_order_release); }

  private:
    static constexpr int kWriter = -1;
    std::atomic<int> count_{0};  // readers, or kWriter
};

/// Uses a handle as long as it lives, if it may.
template <bool (Users::*kEnter)(), void (Users::*kLeave)()>
class Using {
  public:
    explicit Using(Users& users) : users_(users), entered_((users.*kEnter)()) {}
    Using(const Using&) = delete;
    Using& operator=(const Using&) = delete;
    ~Using() {
        if (entered_) (users_.*kLeave)();
    }
    explicit operator bool() const { return entered_; }

  private:
    Users& users_;
    bool entered_;
};
using Reading = Using<&Users::enter_as_reader, &Users::leave_as_reader>;
using Writing = Using<&Users::enter_as_writer, &Users::leave_as_writer>;

}  // namespace opaline::runtime
