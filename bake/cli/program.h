#pragma once

namespace opaline::cli {

/// Runs a command line of `opaline`, its name included: prints, and returns the exit code. Beyond
/// return nothing stays but the handlers of catch_interrupts and the settings of messages.h.
int run_program(int argc, const char* const* argv);

}  // namespace opaline::cli
