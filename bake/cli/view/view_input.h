#pragma once

#include "bake/cli/view/view_panels.h"
#include "bake/cli/view/view_state.h"

namespace opaline::cli {

/// Camera and keys: drag to orbit, drag with the right or middle button to pan, wheel to zoom, R to
/// frame, L to level, Tab to hide the controls. With two pictures the split follows a drag of its
/// edge.
void apply_input(ViewState& state, PanelMemory& memory);

}  // namespace opaline::cli
