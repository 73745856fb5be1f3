#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "bake/base/context.h"

namespace opaline::cli {

enum class ProgressStyle {
    automatic,  ///< a bar with the time left, on a terminal only
    json,       ///< one JSON object a line on stderr
    none
};

/// `--progress`.
void add_progress_option(CLI::App& command, ProgressStyle& style);

/// What a Context calls; may be empty. No bar where messages are quiet.
std::function<void(const bake::Progress&)> make_progress_printer(ProgressStyle style);

}  // namespace opaline::cli
