#include "bake/cli/view/script_run.h"

namespace opaline::cli {

// Whether the step is done.
bool ScriptRun::carry_out(const ScriptStep& step, ViewState& state, const Shown& shown) {
    if (const auto* change = std::get_if<StateChange>(&step.what)) {
        if (!state.viewpoint) return false;
        (*change)(state);
        return true;
    }
    if (const auto* wait = std::get_if<WaitFrames>(&step.what)) {
        return waited_++ >= wait->frames;
    }
    if (std::holds_alternative<WaitReload>(step.what)) {
        return shown.is_reloaded && shown.is_settled;
    }
    if (const auto* screenshot = std::get_if<Screenshot>(&step.what)) {
        // Controls take a few frames to find their sizes.
        constexpr std::size_t kFrames = 4;
        if (!shown.is_settled || shown.settled_frames < kFrames) return false;
        shot_ = *screenshot;
        return true;
    }
    quits_ = true;
    return true;
}

void ScriptRun::advance(ViewState& state, Shown shown) {
    while (!is_done() && !shot_ && !quits_) {
        line_ = steps_[next_].line;
        if (!carry_out(steps_[next_], state, shown)) return;
        // What a change asks for is not drawn yet.
        if (std::holds_alternative<StateChange>(steps_[next_].what)) shown.is_settled = false;
        ++next_;
        waited_ = 0;
    }
    if (is_done()) line_ = 0;
}

}  // namespace opaline::cli
