#include "bake/cli/view/view_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/cli/messages.h"

namespace opaline::cli {
namespace {

[[noreturn]] void refuse_window(const char* doing) {
    const char* text = nullptr;
    ::glfwGetError(&text);
    refuse(formats::make_error(
        formats::ErrorKind::resource, "", "window",
        std::string(doing) + (text != nullptr ? ": " + std::string(text) : std::string()),
        "set DISPLAY or WAYLAND_DISPLAY to a display with OpenGL 3.3; `opaline render` makes "
        "pictures without one"));
}

}  // namespace

struct ViewWindow::Parts {
    GLFWwindow* window = nullptr;
    std::vector<Drop> drops;
    bool has_controls = false;
    bool has_input = false;  // since the last wait; drivers send events of their own

    Parts() = default;
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;
    ~Parts() {
        if (has_controls) {
            ImGui_ImplOpenGL3_Shutdown();
            ImGui_ImplGlfw_Shutdown();
            ImGui::DestroyContext();
        }
        if (window != nullptr) ::glfwDestroyWindow(window);
        ::glfwTerminate();
    }

    template <class... More>
    static void on_input(GLFWwindow* window, More...) {
        static_cast<Parts*>(::glfwGetWindowUserPointer(window))->has_input = true;
    }

    // Before those of Dear ImGui, which calls them on.
    void watch_input() const {
        ::glfwSetCursorPosCallback(window, on_input<double, double>);
        ::glfwSetMouseButtonCallback(window, on_input<int, int, int>);
        ::glfwSetScrollCallback(window, on_input<double, double>);
        ::glfwSetKeyCallback(window, on_input<int, int, int, int>);
        ::glfwSetCharCallback(window, on_input<unsigned>);
        ::glfwSetFramebufferSizeCallback(window, on_input<int, int>);
        ::glfwSetWindowRefreshCallback(window, on_input<>);
        ::glfwSetDropCallback(window, on_drop);
    }

    static void on_drop(GLFWwindow* window, int count, const char** paths) {
        auto& parts = *static_cast<Parts*>(::glfwGetWindowUserPointer(window));
        parts.has_input = true;
        double x = 0, y = 0;
        int width = 1, height = 1;
        ::glfwGetCursorPos(window, &x, &y);
        ::glfwGetWindowSize(window, &width, &height);
        for (int i = 0; i < count; ++i) {
            parts.drops.push_back({paths[i], x / std::max(width, 1)});
        }
    }

    // Text and controls keep their size on displays with more pixels to the inch.
    void scale_controls() const {
        float x = 1, y = 1;
        ::glfwGetWindowContentScale(window, &x, &y);
        int units = 1, height = 1, pixels = 1;
        ::glfwGetWindowSize(window, &units, &height);
        ::glfwGetFramebufferSize(window, &pixels, &height);
        // The part of the scale that the system does not apply to the window's units by itself.
        const float own =
            static_cast<float>(std::max(pixels, 1)) / static_cast<float>(std::max(units, 1));
        const float scale = std::clamp(x / own, 0.5f, 8.0f);
        ImFontConfig font;
        font.SizePixels = std::round(13.0f * x);  // made for pixels, drawn in the window's units
        ImGui::GetIO().Fonts->AddFontDefault(&font);
        ImGui::GetIO().FontGlobalScale = 1.0f / own;
        ImGui::GetStyle().ScaleAllSizes(scale);
    }
};

ViewWindow::ViewWindow(std::uint32_t width, std::uint32_t height) {
    if (::glfwInit() != GLFW_TRUE) refuse_window("no display can be opened");
    parts_ = std::make_unique<Parts>();  // ends GLFW from now on
    ::glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    ::glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    ::glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    ::glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    parts_->window = ::glfwCreateWindow(static_cast<int>(width), static_cast<int>(height),
                                        "Opaline", nullptr, nullptr);
    if (parts_->window == nullptr) refuse_window("no window with OpenGL 3.3 can be made");
    GLFWwindow* const window = parts_->window;
    // Where pixels are smaller than the window's units: as many pixels as were asked for.
    int pixels = 0, rows = 0;
    ::glfwGetFramebufferSize(window, &pixels, &rows);
    if (pixels > 0 && pixels != static_cast<int>(width)) {
        const double factor = static_cast<double>(width) / pixels;
        ::glfwSetWindowSize(window, static_cast<int>(std::lround(width * factor)),
                            static_cast<int>(std::lround(height * factor)));
    }
    ::glfwMakeContextCurrent(window);
    ::glfwSwapInterval(1);
    ::glfwSetWindowUserPointer(window, parts_.get());
    parts_->watch_input();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().LogFilename = nullptr;
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
    parts_->has_controls = true;
    parts_->scale_controls();
}

ViewWindow::~ViewWindow() = default;

ViewWindow::Size ViewWindow::size() const {
    int width = 0, height = 0;
    ::glfwGetFramebufferSize(parts_->window, &width, &height);
    return {static_cast<std::uint32_t>(std::max(width, 0)),
            static_cast<std::uint32_t>(std::max(height, 0))};
}

bool ViewWindow::wants_to_close() const {
    return ::glfwWindowShouldClose(parts_->window) == GLFW_TRUE;
}

bool ViewWindow::wait(double seconds) {
    parts_->has_input = false;
    ::glfwWaitEventsTimeout(seconds);
    return parts_->has_input;
}

std::vector<ViewWindow::Drop> ViewWindow::take_drops() {
    return std::exchange(parts_->drops, {});
}

void ViewWindow::begin_controls() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void ViewWindow::end_controls() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void ViewWindow::swap() {
    ::glfwSwapBuffers(parts_->window);
}

void ViewWindow::set_title(const std::string& title) {
    ::glfwSetWindowTitle(parts_->window, title.c_str());
}

}  // namespace opaline::cli
