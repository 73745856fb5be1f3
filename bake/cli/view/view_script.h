#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bake/cli/view/view_state.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// Changes what is shown. The state has a viewpoint.
using StateChange = std::function<void(ViewState&)>;
/// Multiplies the light of an emitter that one of the files has.
struct EmitterChange {
    std::string name;
    formats::Rgb color{1, 1, 1};
};
/// Shows the window's picture this often before the next step.
struct WaitFrames {
    std::size_t frames = 1;
};
/// Until a file has changed on disk, was read again and is shown.
struct WaitReload {};
/// Writes the picture once it is drawn in full quality, with the window's controls or without.
struct Screenshot {
    std::string path;  ///< .png
    bool with_panels = false;
};
struct Quit {};

struct ScriptStep {
    std::size_t line = 0;  ///< from 1
    std::variant<StateChange, EmitterChange, WaitFrames, WaitReload, Screenshot, Quit> what;
};

/// One command a line, words separated by blanks, "in quotes" where they have some; empty lines and
/// what follows a # are left out. Errors: bad_input naming `file` and the line, all of them.
formats::Result<std::vector<ScriptStep>> parse_script(std::string_view text,
                                                      const std::string& file);

/// The commands and what they do, one a line, for help texts.
std::string script_help();

}  // namespace opaline::cli
