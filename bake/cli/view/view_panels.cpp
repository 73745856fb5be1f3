#include "bake/cli/view/view_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bake/cli/messages.h"
#include "bake/cli/view/view_state.h"

namespace opaline::cli {
namespace {

void say(const std::string& text) {
    ImGui::TextUnformatted(text.c_str());
}

void say_wrapped(const std::string& text) {
    ImGui::PushTextWrapPos(0);
    say(text);
    ImGui::PopTextWrapPos();
}

// From above: +Z, the front of a model, is down, +X to the right. The knob stands where the light's
// +Z has come to.
bool draw_dial(double& degrees, bool& is_held) {
    const float radius = 2.2f * ImGui::GetFrameHeight();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 middle{corner.x + radius, corner.y + radius};
    ImGui::InvisibleButton("dial", {2 * radius, 2 * radius});
    is_held = ImGui::IsItemActive();
    bool is_changed = false;
    if (is_held) {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        const double x = static_cast<double>(mouse.x - middle.x),
                     z = static_cast<double>(mouse.y - middle.y);
        if (x * x + z * z > 4) {
            degrees = std::atan2(x, z) * 180 / std::numbers::pi;
            is_changed = true;
        }
    }
    ImDrawList* const list = ImGui::GetWindowDrawList();
    const ImU32 line = ImGui::GetColorU32(ImGuiCol_Border);
    list->AddCircleFilled(middle, radius, ImGui::GetColorU32(ImGuiCol_FrameBg), 48);
    list->AddCircle(middle, radius, line, 48);
    for (int tick = 0; tick < 12; ++tick) {
        const float a = static_cast<float>(tick) * std::numbers::pi_v<float> / 6;
        const float inner = (tick % 3 == 0 ? 0.82f : 0.91f) * radius;
        list->AddLine({middle.x + inner * std::sin(a), middle.y + inner * std::cos(a)},
                      {middle.x + radius * std::sin(a), middle.y + radius * std::cos(a)},
                      ImGui::GetColorU32(ImGuiCol_TextDisabled));
    }
    const auto a = static_cast<float>(degrees * std::numbers::pi / 180);
    const ImVec2 knob{middle.x + 0.68f * radius * std::sin(a),
                      middle.y + 0.68f * radius * std::cos(a)};
    const ImU32 bright = ImGui::GetColorU32(ImGuiCol_SliderGrabActive);
    list->AddLine(middle, knob, bright, 2);
    list->AddCircleFilled(knob, 0.14f * radius, bright, 24);
    return is_changed;
}

void draw_light(ViewState& state, PanelMemory& memory) {
    constexpr std::array kLights{"studio", "white", "sky:3,35", "sky:3,8", "sun:40,30", "black"};
    double degrees = state.rotate_light;
    if (draw_dial(degrees, memory.dial_held)) rotate_light_to(state, degrees);
    ImGui::SameLine();
    ImGui::BeginGroup();
    auto angle = static_cast<float>(state.rotate_light);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::DragFloat("##angle", &angle, 0.5f, 0, 0, "%.1f deg")) {
        rotate_light_to(state, static_cast<double>(angle));
    }
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##light", printable(state.light).c_str())) {
        for (const char* light : kLights) {
            if (ImGui::Selectable(light, state.light == light)) state.light = light;
        }
        ImGui::EndCombo();
    }
    std::array<char, 1024> text{};
    std::snprintf(text.data(), text.size(), "%s", memory.light_text.c_str());
    ImGui::SetNextItemWidth(-1);
    const bool is_entered =
        ImGui::InputTextWithHint("##other", "file, or sky:T,EL", text.data(), text.size(),
                                 ImGuiInputTextFlags_EnterReturnsTrue);
    memory.light_text = text.data();
    if (is_entered && !memory.light_text.empty()) state.light = memory.light_text;
    ImGui::EndGroup();
}

void draw_look(ViewState& state, float chosen) {
    float exposure = state.exposure.value_or(chosen);
    if (ImGui::SliderFloat("exposure", &exposure, -12, 12, "%.2f EV")) state.exposure = exposure;
    bool is_chosen = !state.exposure;
    if (ImGui::Checkbox("exposure by the picture", &is_chosen)) {
        state.exposure = is_chosen ? std::nullopt : std::optional(exposure);
    }
    bool is_neutral = state.tone_map == runtime::ToneMap::neutral;
    if (ImGui::Checkbox("tone map", &is_neutral)) {
        state.tone_map = is_neutral ? runtime::ToneMap::neutral : runtime::ToneMap::none;
    }
    ImGui::SliderFloat("angle of view", &state.fov, 5, 120, "%.0f deg");
}

void draw_terms(ViewState& state, const FileFacts& facts) {
    for (std::uint32_t bit = 1; bit <= static_cast<std::uint32_t>(facts.terms); bit <<= 1U) {
        const auto term = static_cast<formats::TermSet>(bit);
        if (!has_any(facts.terms, term)) continue;
        bool is_shown = has_any(state.terms, term);
        if (ImGui::Checkbox(formats::term_names(term).c_str(), &is_shown)) {
            toggle_term(state, term);
        }
    }
}

void draw_emitters(ViewState& state, const FileFacts& facts) {
    for (std::size_t e = 0; e < facts.emitters.size(); ++e) {
        ImGui::PushID(static_cast<int>(e));
        formats::Rgb color = emitter_color(state, facts.emitters[e]);
        const float most = std::max({color.r, color.g, color.b});
        float power = most;
        bool is_changed = ImGui::SliderFloat("##power", &power, 0, 4, "%.2f");
        if (is_changed) {
            color = most > 0 ? (power / most) * color : formats::Rgb{power, power, power};
        }
        ImGui::SameLine();
        std::array<float, 3> rgb{color.r, color.g, color.b};
        if (ImGui::ColorEdit3("##color", rgb.data(),
                              ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float |
                                  ImGuiColorEditFlags_HDR)) {
            color = {rgb[0], rgb[1], rgb[2]};
            is_changed = true;
        }
        ImGui::SameLine();
        say(printable(facts.emitters[e]));
        if (is_changed) set_emitter(state, facts.emitters[e], color);
        ImGui::PopID();
    }
}

// Black to white over red and yellow, as error_map.h has it.
void draw_heat_scale(double white) {
    const float line = ImGui::GetFrameHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float third = ImGui::GetContentRegionAvail().x / 3;
    constexpr std::array<ImU32, 4> kColors{IM_COL32(0, 0, 0, 255), IM_COL32(255, 0, 0, 255),
                                           IM_COL32(255, 255, 0, 255),
                                           IM_COL32(255, 255, 255, 255)};
    for (std::size_t i = 0; i < 3; ++i) {
        const float left = at.x + third * static_cast<float>(i);
        ImGui::GetWindowDrawList()->AddRectFilledMultiColor(
            {left, at.y}, {left + third, at.y + 0.6f * line}, kColors[i], kColors[i + 1],
            kColors[i + 1], kColors[i]);
    }
    ImGui::Dummy({3 * third, 0.6f * line});
    say(fmt::format("0 to {:.3g} %: rows, white light", 100 * white));
}

void draw_receiver_errors(ViewState& state, const formats::ErrorSummary& errors) {
    constexpr double kLeast = 1e-4, kMost = 1;
    bool is_map = state.error_white > 0;
    if (ImGui::Checkbox("errors by vertex", &is_map)) {
        state.error_white = is_map ? static_cast<float>(std::clamp(errors.p95, kLeast, kMost)) : 0;
    }
    if (state.error_white > 0) {
        float percent = 100 * state.error_white;
        if (ImGui::SliderFloat("white", &percent, 0.01f, 100, "%.3g %%",
                               ImGuiSliderFlags_Logarithmic)) {
            state.error_white = percent / 100;
        }
        draw_heat_scale(static_cast<double>(state.error_white));
    }
}

void draw_accuracy(ViewState& state, const DrawnSide& side) {
    const FileFacts& facts = side.facts;
    if (facts.has_receiver_errors) draw_receiver_errors(state, facts.receiver_errors);
    if (facts.coefficients > 6) {
        const int all = static_cast<int>(facts.coefficients);
        int kept = static_cast<int>(
            std::min(state.coefficients.value_or(facts.coefficients), facts.coefficients));
        if (ImGui::SliderInt("coefficients", &kept, 6, all, "%d", ImGuiSliderFlags_Logarithmic)) {
            state.coefficients.reset();
            if (kept < all) state.coefficients = static_cast<std::uint32_t>(std::max(kept, 6));
        }
        if (state.coefficients) {
            say(fmt::format("{:.2f} % from all {}, this light", 100 * side.coefficient_error, all));
        }
    }
    if (facts.error >= 0) say(fmt::format("{:.2f} % error, as baked", 100 * facts.error));
}

void say_seconds(const char* name, double seconds) {
    say(fmt::format("{:<13}{}", name, format_seconds(seconds)));
}

void draw_timings(const DrawnView& drawn, const PanelMemory& memory) {
    const ViewSeconds& seconds = drawn.file.seconds;
    say_seconds("load", seconds.load);
    say_seconds("upload", seconds.upload);
    say_seconds("light", seconds.light);
    say_seconds("dot products", seconds.dots);
    say_seconds("draw", seconds.draw);
    say_seconds("read back", seconds.readback);
    say_seconds("to window", memory.to_window);
    say(fmt::format("{:<13}{:.0f} Hz", "window", memory.frames_per_second));
    say(fmt::format("{:<13}{}", "on the GPU",
                    format_bytes(static_cast<double>(drawn.file.facts.gpu_bytes))));
    say_wrapped(drawn.file.facts.device);
}

void draw_files(ViewState& state, const DrawnView* drawn) {
    say_wrapped(printable(state.file));
    if (drawn != nullptr && drawn->file.facts.receivers > 0) {
        say(fmt::format("{} receivers", drawn->file.facts.receivers));
    }
    if (!state.other.empty()) {
        say_wrapped("right: " + printable(state.other));
        ImGui::SliderFloat("split", &state.split, 0, 1, "%.2f");
        bool is_difference = state.difference_gain > 0;
        if (ImGui::Checkbox("difference", &is_difference)) {
            state.difference_gain = is_difference ? 4.0f : 0.0f;
        }
        if (is_difference) {
            ImGui::SameLine();
            ImGui::SetNextItemWidth(-1);
            ImGui::SliderFloat("##gain", &state.difference_gain, 0.25f, 64, "times %.2f",
                               ImGuiSliderFlags_Logarithmic);
        }
        if (ImGui::Button("one file")) state.other.clear();
    }
    if (ImGui::Button("frame")) state.viewpoint.reset();
}

// The line that a drag moves: dark pictures and like ones do not show where it is.
void draw_split(const ViewState& state) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float line = ImGui::GetFrameHeight();
    const float x = std::round(state.split * size.x), y = size.y / 2;
    const ImU32 bright = ImGui::GetColorU32(ImGuiCol_SliderGrabActive);
    ImDrawList* const list = ImGui::GetBackgroundDrawList();
    list->AddLine({x, 0}, {x, size.y}, bright, 0.08f * line);
    list->AddRectFilled({x - 0.2f * line, y - line}, {x + 0.2f * line, y + line}, bright,
                        0.2f * line);
}

}  // namespace

PanelWishes draw_panels(ViewState& state, PanelMemory& memory, const DrawnView* drawn) {
    PanelWishes wishes;
    if (!state.panels) return wishes;
    if (!state.other.empty()) draw_split(state);
    const float line = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({0.4f * line, 0.4f * line}, ImGuiCond_Once);
    ImGui::SetNextWindowSizeConstraints({15 * line, 2 * line},
                                        {15 * line, ImGui::GetIO().DisplaySize.y - 0.8f * line});
    ImGui::SetNextWindowBgAlpha(0.82f);
    if (ImGui::Begin("Opaline", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        ImGui::PushItemWidth(7.5f * line);
        if (!memory.message.empty()) {
            ImGui::PushStyleColor(ImGuiCol_Text, {1.0f, 0.5f, 0.4f, 1.0f});
            say_wrapped(memory.message);
            ImGui::PopStyleColor();
        }
        draw_files(state, drawn);
        ImGui::SameLine();
        if (ImGui::Checkbox("free orbit", &memory.free_orbit) && !memory.free_orbit &&
            state.viewpoint) {
            state.viewpoint = level(*state.viewpoint);
        }
        ImGui::SameLine();
        wishes.screenshot = ImGui::Button("screenshot");
        constexpr ImGuiTreeNodeFlags kOpen = ImGuiTreeNodeFlags_DefaultOpen;
        if (ImGui::CollapsingHeader("Light", kOpen)) draw_light(state, memory);
        if (ImGui::CollapsingHeader("Picture", kOpen))
            draw_look(state, drawn != nullptr ? drawn->exposure : 0.0f);
        if (drawn != nullptr) {
            const FileFacts& facts = drawn->file.facts;
            if (!facts.emitters.empty() && ImGui::CollapsingHeader("Emitters", kOpen)) {
                draw_emitters(state, facts);
            }
            if (facts.has_layer && ImGui::CollapsingHeader("Clouds", kOpen)) {
                auto time = static_cast<float>(state.time);
                if (ImGui::DragFloat("time", &time, 5, -86400, 86400, "%.0f s")) {
                    state.time = static_cast<double>(time);
                }
            }
            if (facts.terms != formats::TermSet::none && ImGui::CollapsingHeader("Components")) {
                draw_terms(state, facts);
            }
            if ((facts.receivers > 0 || facts.error >= 0) &&
                ImGui::CollapsingHeader("Accuracy", kOpen)) {
                draw_accuracy(state, drawn->file);
            }
            if (ImGui::CollapsingHeader("Timings", kOpen)) draw_timings(*drawn, memory);
        }
        if (!memory.command_line.empty() && ImGui::CollapsingHeader("Last screenshot", kOpen)) {
            say_wrapped(memory.command_line);
            if (ImGui::Button("copy")) ImGui::SetClipboardText(memory.command_line.c_str());
        }
        ImGui::PopItemWidth();
    }
    ImGui::End();
    return wishes;
}

}  // namespace opaline::cli
