#pragma once

#include <string>

#include "bake/cli/view/draw_thread.h"
#include "bake/cli/view/view_state.h"

namespace opaline::cli {

/// What the controls remember beside the state.
struct PanelMemory {
    bool free_orbit = false;  ///< arcball; else the horizon stays level
    bool dial_held = false;
    std::string light_text;        ///< being typed
    std::string command_line;      ///< of the last screenshot
    std::string message;           ///< the last error
    double to_window = 0;          ///< of the last picture, to the window's OpenGL [s]
    double frames_per_second = 0;  ///< of the window
};

/// What the controls ask for beside changes of the state.
struct PanelWishes {
    bool screenshot = false;
};

/// Draws the controls and applies what the user does with them. `drawn`: what is shown, or null.
PanelWishes draw_panels(ViewState& state, PanelMemory& memory, const DrawnView* drawn);

}  // namespace opaline::cli
