#pragma once

#include <functional>
#include <string>

#include "bake/base/context.h"

namespace opaline::cli {

enum class ProgressStyle {
    automatic,  ///< a bar with the time left, on a terminal only
    json,       ///< one JSON object a line on stderr
    none
};

/// What a Context calls; may be empty.
std::function<void(const bake::Progress&)> make_progress_printer(ProgressStyle style);

}  // namespace opaline::cli
