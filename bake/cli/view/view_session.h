#pragma once

#include <string>
#include <vector>

#include "bake/cli/view/view_script.h"
#include "bake/cli/view/view_state.h"

namespace opaline::cli {

/// Opens a window and shows the state until it is closed or a step of the script says so; prints a
/// `render` line for every screenshot. `script` is the script's name, for messages. Gives an exit
/// code, and reports errors: resource, where there is no display; what a step of the script asked
/// for and could not be done. Without a script errors of the latter kind are shown in the window.
int run_view(const ViewState& begin, const std::vector<ScriptStep>& steps,
             const std::string& script);

}  // namespace opaline::cli
