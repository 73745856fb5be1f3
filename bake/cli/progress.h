#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <string>

#include "bake/base/context.h"
#include "bake/cli/command.h"

namespace opaline::cli {

/// From now on SIGINT, SIGTERM and SIGHUP set the returned flag instead of ending the program, so
/// that temporary files are removed on the way out. A second signal ends it at once. Signals that
/// the program was told to ignore, as by nohup, stay ignored.
const std::atomic<bool>& catch_interrupts();

enum class ProgressStyle {
    automatic,  ///< a bar with the time left, on a terminal only
    json,       ///< one JSON object a line on stderr
    none
};

/// `--progress`.
void add_progress_option(const Command& command, ProgressStyle& style);

/// What a Context calls; may be empty. No bar where messages are quiet.
///
/// As JSON each line has `event`, `stage`, `done`, `total`, `seconds` since the stage began and
/// `eta_seconds` until it ends, null where unknown. `event` is begin, step or end; a stage has one
/// begin, one end where it comes to it, and a step for each twentieth at most; what is gone through
/// again within a second of its end has none. The command's own line comes first, with the stage
/// `job`, and last, once `printer({job, 1, 1})` says so.
std::function<void(const bake::Progress&)> make_progress_printer(ProgressStyle style,
                                                                 const std::string& job);

/// A line of it; empty: none is due. Keeps what it has to know of the stages.
class ProgressLines {
  public:
    std::string next(const bake::Progress& progress, double seconds_now);

  private:
    struct Stage {
        double begin = 0, last_share = 0;
        double next = 0;  ///< a stage that is gone through again is silent until then
        bool is_open = false;
    };
    std::map<std::string, Stage, std::less<>> stages_;
};

}  // namespace opaline::cli
