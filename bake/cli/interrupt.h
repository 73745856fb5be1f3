#pragma once

#include <atomic>

namespace opaline::cli {

/// From now on SIGINT, SIGTERM and SIGHUP set the returned flag instead of ending the program, so
/// that temporary files are removed on the way out. A second signal ends it at once. Signals that
/// the program was told to ignore, as by nohup, stay ignored.
const std::atomic<bool>& catch_interrupts();

}  // namespace opaline::cli
