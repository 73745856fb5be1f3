#pragma once

#include <atomic>

namespace opaline::cli {

/// From now on SIGINT and SIGTERM set the returned flag instead of ending the program, so that
/// temporary files are removed on the way out. A second signal ends it at once.
const std::atomic<bool>& catch_interrupts();

}  // namespace opaline::cli
