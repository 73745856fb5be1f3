#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "bake/cli/view/view_script.h"

namespace opaline::cli {

/// How far a script has come.
class ScriptRun {
  public:
    /// What of the session steps wait for.
    struct Shown {
        bool is_settled = false;         ///< the state is drawn in full quality
        std::size_t settled_frames = 0;  ///< shown since then
        bool is_reloaded = false;        ///< a file that changed on disk was read again
    };

    explicit ScriptRun(std::vector<ScriptStep> steps) : steps_(std::move(steps)) {}

    /// Carries steps out until one waits, takes a picture or ends the session.
    void advance(ViewState& state, Shown shown);

    bool is_done() const { return next_ == steps_.size(); }
    bool quits() const { return quits_; }
    std::size_t line() const { return line_; }  ///< carried out last; 0: the window is the user's
    /// The picture to take before the next step; none from then on.
    std::optional<Screenshot> take_shot() { return std::exchange(shot_, std::nullopt); }

  private:
    bool carry_out(const ScriptStep& step, ViewState& state, const Shown& shown);

    std::vector<ScriptStep> steps_;
    std::size_t next_ = 0, waited_ = 0, line_ = 0;
    std::optional<Screenshot> shot_;
    bool quits_ = false;
};

}  // namespace opaline::cli
