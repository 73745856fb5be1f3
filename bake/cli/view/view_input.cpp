#include "bake/cli/view/view_input.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "bake/cli/view/orbit_camera.h"

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

}  // namespace

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

}  // namespace opaline::cli
