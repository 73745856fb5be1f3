#pragma once

#include <string>

#include "bake/cli/view/view_state.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// A file that was dropped on the window at `share` of its width: an `.opal` file is shown in place
/// of the one there, an .exr or .hdr file is the light. Errors: usage, for other endings.
formats::Status drop_file(ViewState& state, const std::string& path, double share);

}  // namespace opaline::cli
