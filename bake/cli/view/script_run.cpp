#include "bake/cli/view/script_run.h"

#include <algorithm>
#include <string>

namespace opaline::cli {
namespace {

bool shows_the_same_files(const ViewState& a, const ViewState& b) {
    return a.file == b.file && a.other == b.other && a.light == b.light;
}

bool has_name(std::span<const std::string> names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

formats::Error refuse_emitter(const std::string& name, const ScriptRun::Shown& shown) {
    std::string known;
    for (const auto& names : {shown.emitters, shown.other_emitters}) {
        for (const std::string& one : names)
            known += (known.empty() ? "" : ", ") + one;
    }
    return formats::make_error(
        formats::ErrorKind::bad_input, "", "", "no emitter has the name '" + name + "'",
        known.empty() ? "there is none at all: bake a scene with lamps" : "there are " + known);
}

}  // namespace

// Whether the step is done.
bool ScriptRun::carry_out(const ScriptStep& step, ViewState& state, const Shown& shown) {
    if (const auto* change = std::get_if<StateChange>(&step.what)) {
        if (!state.viewpoint) return false;
        const ViewState before = state;
        (*change)(state);
        opens_ = !shows_the_same_files(before, state);
        return true;
    }
    if (const auto* change = std::get_if<EmitterChange>(&step.what)) {
        if (!shown.is_settled) return false;  // the names are those of the files before
        if (!has_name(shown.emitters, change->name) &&
            !has_name(shown.other_emitters, change->name)) {
            error_ = refuse_emitter(change->name, shown);
            return false;
        }
        set_emitter(state, change->name, change->color);
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
    if (next_ == steps_.size() && (shown.is_settled || quits_)) {
        is_done_ = true;
        line_ = 0;
    }
    while (next_ < steps_.size() && !shot_ && !quits_) {
        if (opens_ && !shown.is_settled) return;
        opens_ = false;
        const ScriptStep& step = steps_[next_];
        line_ = step.line;
        if (!carry_out(step, state, shown)) return;
        // What a change asks for is not drawn yet.
        if (std::holds_alternative<StateChange>(step.what) ||
            std::holds_alternative<EmitterChange>(step.what)) {
            shown.is_settled = false;
        }
        ++next_;
        waited_ = 0;
    }
}

}  // namespace opaline::cli
