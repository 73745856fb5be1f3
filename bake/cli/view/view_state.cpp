#include "bake/cli/view/view_state.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace opaline::cli {

runtime::Camera camera_of(const ViewState& state, const Viewpoint& from) {
    runtime::Camera camera;
    camera.eye = from.eye;
    camera.target = from.target;
    camera.up = from.up;
    camera.fov_y = state.fov;
    camera.width = state.width;
    camera.height = state.height;
    return camera;
}

bool same_radiance(const ViewState& a, const ViewState& b) {
    const auto parts = [](const ViewState& s) {
        return std::tie(s.file, s.other, s.light, s.viewpoint, s.width, s.height, s.fov,
                        s.rotate_light, s.time, s.terms, s.coefficients, s.emitters, s.error_white);
    };
    return parts(a) == parts(b);
}

void rotate_light_to(ViewState& state, double degrees) {
    const double turned = std::fmod(degrees, 360.0);
    state.rotate_light = turned < 0 ? turned + 360.0 : turned;
    if (state.rotate_light >= 360.0) state.rotate_light = 0;  // of -1e-300
}

void set_emitter(ViewState& state, const std::string& name, formats::Rgb color) {
    std::erase_if(state.emitters,
                  [&](const EmitterColor& emitter) { return emitter.name == name; });
    if (color.r != 1.0f || color.g != 1.0f || color.b != 1.0f) {
        state.emitters.push_back({name, color});
    }
}

formats::Rgb emitter_color(const ViewState& state, const std::string& name) {
    for (const EmitterColor& emitter : state.emitters) {
        if (emitter.name == name) return emitter.color;
    }
    return {1, 1, 1};
}

void toggle_term(ViewState& state, formats::TermSet term) {
    state.terms = has_any(state.terms, term) ? state.terms & ~term : state.terms | term;
}

void show_file(ViewState& state, const std::string& path) {
    state.file = path;
    state.viewpoint.reset();
    state.coefficients.reset();
    state.terms = formats::TermSet::baked;
    state.emitters.clear();
    state.error_white = 0;
}

}  // namespace opaline::cli
