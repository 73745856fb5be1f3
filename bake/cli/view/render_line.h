#pragma once

#include <string>

#include "bake/cli/view/view_state.h"

namespace opaline::cli {

/// The command line of `opaline render` that draws this state's picture of `file` from `from`:
/// words for a shell. Numbers are written so that they are read back with the same bits.
std::string render_line(const ViewState& state, const std::string& file, const Viewpoint& from,
                        const std::string& output);

/// A word for a POSIX shell: as it is, or in single quotes where it has other characters than
/// letters, digits and _./:,=+-@%.
std::string quote_word(const std::string& word);

}  // namespace opaline::cli
