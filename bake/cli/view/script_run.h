#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
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
        std::span<const std::string> emitters = {}, other_emitters = {};  ///< names, of both files
    };

    explicit ScriptRun(std::vector<ScriptStep> steps)
        : steps_(std::move(steps)), is_done_(steps_.empty()) {}

    /// Carries steps out until one waits, takes a picture, fails or ends the session. After another
    /// file or light the next one waits until it is shown, so that what cannot be shown is the
    /// fault of its line, the last one's too.
    void advance(ViewState& state, Shown shown);

    /// The last step is carried out and shown: until then what fails is the script's fault.
    bool is_done() const { return is_done_; }
    bool quits() const { return quits_; }
    /// A step that cannot be carried out.
    const std::optional<formats::Error>& error() const { return error_; }
    /// Carried out last, or waiting for itself; 0: the window is the user's.
    std::size_t line() const { return line_; }
    /// The picture to take before the next step; none from then on.
    std::optional<Screenshot> take_shot() { return std::exchange(shot_, std::nullopt); }

  private:
    bool carry_out(const ScriptStep& step, ViewState& state, const Shown& shown);

    std::vector<ScriptStep> steps_;
    std::size_t next_ = 0, waited_ = 0, line_ = 0;
    std::optional<Screenshot> shot_;
    std::optional<formats::Error> error_;
    bool quits_ = false, is_done_;
    bool opens_ = false;  ///< another file or light is not shown yet
};

}  // namespace opaline::cli
