#include "bake/cli/view/dropped_file.h"

#include <filesystem>

namespace opaline::cli {

formats::Status drop_file(ViewState& state, const std::string& path, double share) {
    const std::string ending = std::filesystem::path(path).extension().string();
    if (ending == ".exr" || ending == ".hdr") {
        state.light = path;
        return formats::ok_status();
    }
    if (ending != ".opal") {
        return formats::make_error(formats::ErrorKind::usage, path, "",
                                   "is no .opal, .exr or .hdr file",
                                   "drop a baked asset or a light");
    }
    if (!state.other.empty() && share > static_cast<double>(state.split)) {
        state.other = path;
    } else {
        show_file(state, path);
    }
    return formats::ok_status();
}

}  // namespace opaline::cli
