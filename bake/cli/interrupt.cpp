#include "bake/cli/interrupt.h"

#include <csignal>

namespace opaline::cli {
namespace {

// A signal handler can reach nothing but a global.
std::atomic<bool> interrupt_caught = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int number) {
    interrupt_caught.store(true);
    std::signal(number, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& catch_interrupts() {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        if (std::signal(number, on_signal) == SIG_IGN) {
            std::signal(number, SIG_IGN);
        }
    }
    return interrupt_caught;
}

}  // namespace opaline::cli
