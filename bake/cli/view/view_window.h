#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace opaline::cli {

/// A window with an OpenGL 3.3 context, current on the thread that made it, and Dear ImGui.
/// Nothing of it is remembered: there is no imgui.ini. One at a time.
class ViewWindow {
  public:
    /// Of so many pixels of the picture. Throws Refusal (messages.h): resource, where no window
    /// can be had.
    ViewWindow(std::uint32_t width, std::uint32_t height);
    ViewWindow(const ViewWindow&) = delete;
    ViewWindow& operator=(const ViewWindow&) = delete;
    ~ViewWindow();

    /// Pixels of the picture, which are more than units of the window where the display has more
    /// than it says.
    struct Size {
        std::uint32_t width = 1, height = 1;
    };
    Size size() const;

    bool wants_to_close() const;
    /// Waits for input, for so many seconds at most. Whether there was any.
    bool wait(double seconds);
    /// Files dropped since the last call, and where: share of the width.
    struct Drop {
        std::string path;
        double share = 0;
    };
    std::vector<Drop> take_drops();

    void begin_controls();
    /// Draws them onto the framebuffer that is bound.
    void end_controls();
    void swap();
    void set_title(const std::string& title);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace opaline::cli
