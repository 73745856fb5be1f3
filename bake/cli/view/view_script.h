#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "bake/cli/view/view_state.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// A file that was dropped on the window at `share` of its width: an `.opal` file is shown in place
/// of the one there, an .exr or .hdr file is the light. Errors: usage, for other endings.
formats::Status drop_file(ViewState& state, const std::string& path, double share);

/// A line of a script as words, up to a #; what stands "in quotes" is one. Nothing where a quote is
/// not closed.
std::optional<std::vector<std::string>> words_of(std::string_view line);

/// A number within the bounds; nothing where the text is none.
std::optional<double> number_in(const std::string& text, double least, double most);
/// `count` of them; nothing where a word is none, or there are more or fewer.
std::optional<std::vector<double>> numbers_in(std::span<const std::string> words, std::size_t count,
                                              double least, double most);

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

/// The command line of `opaline render` that draws this state's picture of `file` from `from`:
/// words for a shell. Numbers are written so that they are read back with the same bits.
std::string render_line(const ViewState& state, const std::string& file, const Viewpoint& from,
                        const std::string& output);

/// A word for a POSIX shell: as it is, or in single quotes where it has other characters than
/// letters, digits and _./:,=+-@%.
std::string quote_word(const std::string& word);

}  // namespace opaline::cli
