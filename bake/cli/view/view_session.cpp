#include "bake/cli/view/view_session.h"

#include <imgui.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "bake/cli/command.h"
#include "bake/cli/messages.h"
#include "bake/cli/progress.h"
#include "bake/cli/view/draw_thread.h"
#include "bake/cli/view/picture_painter.h"
#include "bake/cli/view/view_panels.h"
#include "bake/cli/view/view_script.h"
#include "bake/cli/view/view_state.h"
#include "bake/cli/view/view_window.h"
#include "formats/image/png.h"

namespace opaline::cli {
namespace {

// Whether the split takes this drag.
bool drag_split(ViewState& state, const ImGuiIO& io) {
    if (state.other.empty()) return false;
    const float edge = state.split * io.DisplaySize.x;
    const float reach = 0.4f * ImGui::GetFrameHeight();
    const bool began_there = std::abs(io.MouseClickedPos[0].x - io.MouseDelta.x - edge) < reach ||
                             std::abs(io.MousePos.x - io.MouseDelta.x - edge) < reach;
    if (std::abs(io.MousePos.x - edge) < reach) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left) || !began_there) return false;
    state.split = std::clamp(io.MousePos.x / std::max(io.DisplaySize.x, 1.0f), 0.0f, 1.0f);
    return true;
}

void drag_camera(ViewState& state, const PanelMemory& memory, const ImGuiIO& io) {
    const double width = static_cast<double>(io.DisplaySize.x),
                 height = static_cast<double>(std::max(io.DisplaySize.y, 1.0f));
    const double x = static_cast<double>(io.MousePos.x), y = static_cast<double>(io.MousePos.y);
    const double dx = static_cast<double>(io.MouseDelta.x),
                 dy = static_cast<double>(io.MouseDelta.y);
    // How the mouse came to where a button went down is no drag.
    if (dx * dx + dy * dy == 0 || ImGui::IsMouseClicked(ImGuiMouseButton_Left) ||
        ImGui::IsMouseClicked(ImGuiMouseButton_Right) ||
        ImGui::IsMouseClicked(ImGuiMouseButton_Middle)) {
        return;
    }
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right) || ImGui::IsMouseDown(ImGuiMouseButton_Middle)) {
        state.viewpoint = pan(*state.viewpoint, state.fov, dx / height, -dy / height);
    } else if (ImGui::IsMouseDown(ImGuiMouseButton_Left) && memory.free_orbit) {
        state.viewpoint = turn_ball(*state.viewpoint, ball_point(x - dx, y - dy, width, height),
                                    ball_point(x, y, width, height));
    } else if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        constexpr double kTurn = 180;  // over the height of the window [degrees]
        state.viewpoint = orbit_level(*state.viewpoint, -kTurn * dx / height, kTurn * dy / height);
    }
}

/// Camera and keys: drag to orbit, drag with the right or middle button to pan, wheel to zoom, R to
/// frame, L to level, Tab to hide the controls. With two pictures the split follows a drag of its
/// edge.
void apply_input(ViewState& state, PanelMemory& memory) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.WantTextInput) {
        // Keys by the symbol they make, which GLFW numbers as ASCII does.
        if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Tab), false)) {
            state.panels = !state.panels;
        }
        if (ImGui::IsKeyPressed('R', false)) state.viewpoint.reset();
        if (ImGui::IsKeyPressed('L', false) && state.viewpoint) {
            state.viewpoint = level(*state.viewpoint);
        }
    }
    if (io.WantCaptureMouse || !state.viewpoint) return;
    if (!drag_split(state, io)) drag_camera(state, memory, io);
    if (io.MouseWheel != 0) {
        state.viewpoint = zoom(*state.viewpoint, std::pow(0.9, static_cast<double>(io.MouseWheel)));
    }
}

using SessionClock = std::chrono::steady_clock;

// What it says on a terminal, where it does not stand among other programs' lines.
std::string message_of(const formats::Error& error) {
    const std::string line = format_diagnostic(error.diagnostics.front());
    const std::string prefix = "opaline: error: ";
    return line.rfind(prefix, 0) == 0 ? line.substr(prefix.size()) : line;
}

// With the emitters that the file has: `render` refuses others.
std::string line_of(ViewState state, const std::string& file, const DrawnSide& side,
                    const std::string& output) {
    std::erase_if(state.emitters, [&](const EmitterColor& emitter) {
        return std::ranges::find(side.facts.emitters, emitter.name) == side.facts.emitters.end();
    });
    return render_line(state, file, *state.viewpoint, output);
}

class Session {
  public:
    Session(const ViewState& begin, const std::vector<ScriptStep>& steps)
        : window_(begin.width, begin.height), state_(begin), script_(steps) {
        window_.set_title("Opaline: " + begin.file);
    }

    int run(const std::string& script_name);

  private:
    // The end of the session, or nothing yet.
    std::optional<int> take_drawn(bool has_script);
    void take_input();
    void advance_script();
    void send_request();
    bool is_sent() const;
    bool wants_exact() const;
    bool is_settled() const;
    void paint_frame();
    float exposure() const;  // that is shown [EV]
    formats::Status save(const Screenshot& shot);
    int end_with(const formats::Error& error) const;
    std::string next_name() const;
    bool is_idle() const;

    ViewWindow window_;
    PicturePainter painter_;
    ViewState state_;
    PanelMemory memory_;
    DrawThread thread_;
    DrawRequest sent_;
    std::optional<ViewState> good_;  // the last that could be drawn
    std::shared_ptr<const DrawnView> drawn_;
    std::uint64_t final_serial_ = 0;  // of the last request that was drawn in full quality
    WatchedFiles files_;
    SessionClock::time_point second_ = SessionClock::now();
    SessionClock::time_point last_input_ = SessionClock::now();
    std::size_t frames_ = 0, frames_of_second_ = 0, settled_frames_ = 0;
    std::size_t reloads_ = 0;  // since the last screenshot
    ScriptRun script_;
    std::string script_name_;
    std::optional<Screenshot> shot_;
    bool wants_shot_ = false;  // as soon as it is drawn
};

int Session::end_with(const formats::Error& error) const {
    formats::Error located = error;
    if (script_.line() != 0) {
        std::string& where = located.diagnostics.front().where;
        where = fmt::format("{} line {}{}{}", script_name_, script_.line(),
                            where.empty() ? "" : ": ", where);
    }
    return report_error(located);
}

// Whether the state, with the files as they are now, was sent.
bool Session::is_sent() const {
    return sent_.serial > 0 && same_radiance(state_, sent_.state) &&
           sent_.version == files_.versions() && (sent_.is_exact || !wants_exact());
}

// Scripts and screenshots.
bool Session::wants_exact() const {
    return !script_.is_done() || wants_shot_;
}

bool Session::is_settled() const {
    return drawn_ && final_serial_ == sent_.serial && is_sent();
}

void Session::send_request() {
    if (is_sent()) return;
    const bool is_renamed = good_ && (state_.file != good_->file || state_.other != good_->other ||
                                      state_.light != good_->light);
    const bool is_read_again = sent_.version != files_.versions();
    if (is_renamed || is_read_again) memory_.message.clear();
    sent_ = {state_, sent_.serial + 1, files_.versions(), wants_exact()};
    settled_frames_ = 0;
    thread_.request(sent_);
}

std::optional<int> Session::take_drawn(bool has_script) {
    const auto drawn = thread_.take();
    if (!drawn) return {};
    if (drawn->error) {
        if (has_script || !good_) return end_with(*drawn->error);
        memory_.message = message_of(*drawn->error);
        if (drawn->serial == sent_.serial) {
            const bool shows_panels = state_.panels;
            state_ = *good_;
            state_.panels = shows_panels;
        }
        return {};
    }
    drawn_ = drawn;
    const auto start = SessionClock::now();
    painter_.upload(0, drawn->file.picture);
    painter_.upload(1, drawn->other.picture);
    memory_.to_window = std::chrono::duration<double>(SessionClock::now() - start).count();
    if (drawn->serial != sent_.serial) return {};
    if (!state_.viewpoint && !sent_.state.viewpoint) {
        state_.viewpoint = sent_.state.viewpoint = drawn->viewpoint;
    }
    good_ = sent_.state;
    if (drawn->is_final) final_serial_ = drawn->serial;
    return {};
}

void Session::take_input() {
    for (const ViewWindow::Drop& drop : window_.take_drops()) {
        if (auto status = drop_file(state_, drop.path, drop.share); !status) {
            memory_.message = message_of(status.error());
        }
    }
    const ViewWindow::Size size = window_.size();
    if (size.width > 0 && size.height > 0) {
        state_.width = size.width;
        state_.height = size.height;
    }
}

std::string Session::next_name() const {
    const std::string stem = std::filesystem::path(state_.file).stem().string();
    std::string name;
    for (int number = 1; name.empty() || std::filesystem::exists(name); ++number) {
        name = fmt::format("{}-{:04}.png", stem, number);
    }
    return name;
}

formats::Status Session::save(const Screenshot& shot) {
    runtime::DisplayPicture image = painter_.read();
    if (auto status =
            formats::write_png(shot.path, {image.width, image.height, std::move(image.rgba)});
        !status) {
        return status;
    }
    reloads_ = 0;
    if (shot.with_panels) return formats::ok_status();
    ViewState shown = state_;
    shown.exposure = exposure();
    std::string lines = line_of(shown, state_.file, drawn_->file, shot.path);
    if (!state_.other.empty()) {
        lines += "\n" + line_of(shown, state_.other, drawn_->other, shot.path);
    }
    fmt::print("{}\n", lines);
    std::fflush(stdout);
    memory_.command_line = lines;
    return formats::ok_status();
}

// Nothing moves: no script, no picture that is drawn, no input of late.
bool Session::is_idle() const {
    constexpr std::chrono::milliseconds kStill{400};
    return script_.is_done() && is_settled() && !wants_shot_ &&
           SessionClock::now() - last_input_ > kStill;
}

float Session::exposure() const {
    return state_.exposure.value_or(drawn_ ? drawn_->exposure : 0.0f);
}

void Session::paint_frame() {
    ++frames_;
    ++settled_frames_;
    const std::chrono::duration<double> passed = SessionClock::now() - second_;
    if (passed.count() >= 1) {
        memory_.frames_per_second =
            static_cast<double>(frames_ - frames_of_second_) / passed.count();
        frames_of_second_ = frames_;
        second_ = SessionClock::now();
    }
    // Colours of errors are shown as they are.
    const bool is_light = state_.error_white == 0;
    painter_.paint(
        state_.width, state_.height,
        {is_light ? exposure() : 0.0f, is_light ? state_.tone_map : runtime::ToneMap::none,
         state_.split, state_.difference_gain});
}

void Session::advance_script() {
    ScriptRun::Shown shown{is_settled(), settled_frames_, reloads_ > 0};
    if (drawn_) {
        shown.emitters = drawn_->file.facts.emitters;
        shown.other_emitters = drawn_->other.facts.emitters;
    }
    script_.advance(state_, shown);
}

int Session::run(const std::string& script_name) {
    script_name_ = script_name;
    const std::atomic<bool>& interrupted = catch_interrupts();
    while (!window_.wants_to_close()) {
        if (interrupted.load()) return kExitInterrupted;
        const bool is_still = is_idle();
        const bool has_input = window_.wait(is_still ? 0.1 : 0.01);
        if (has_input) last_input_ = SessionClock::now();
        reloads_ += files_.look(state_);
        if (is_still && !has_input && is_sent()) continue;  // the window shows it already
        take_input();
        if (const auto code = take_drawn(!script_.is_done())) return *code;
        if (!shot_) {
            advance_script();
            if (script_.error()) return end_with(*script_.error());
            shot_ = script_.take_shot();
        }
        if (script_.quits()) return kExitSuccess;
        send_request();
        paint_frame();
        if (shot_ && !shot_->with_panels) {
            if (auto status = save(*shot_); !status) return end_with(status.error());
            shot_.reset();
        }
        window_.begin_controls();
        apply_input(state_, memory_);
        const PanelWishes wishes = draw_panels(state_, memory_, drawn_.get());
        window_.end_controls();
        if (shot_) {
            if (auto status = save(*shot_); !status) return end_with(status.error());
            shot_.reset();
        }
        wants_shot_ |= wishes.screenshot;
        if (wants_shot_ && is_settled()) {
            shot_ = Screenshot{next_name(), false};
            wants_shot_ = false;
        }
        painter_.show();
        window_.swap();
    }
    return kExitSuccess;
}

}  // namespace

int run_view(const ViewState& begin, const std::vector<ScriptStep>& steps,
             const std::string& script) {
    return Session(begin, steps).run(script);
}

}  // namespace opaline::cli
