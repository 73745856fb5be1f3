#include "runtime/gl/gl_relight.h"

#include <algorithm>
#include <string>

#include "runtime/embed_gl/saved_state.h"
#include "runtime/gl/egl_context.h"
#include "runtime/gl/render_on_cpu.h"

namespace opaline::runtime {
namespace {

formats::Status as_status(opaline_status status) {
    if (status == OPALINE_OK) return formats::ok_status();
    return formats::make_error(formats::ErrorKind::resource, {}, "OpenGL", opaline_last_error(),
                               kRenderOnCpu);
}

formats::Status check_lights(const PartLights& lights, const Relight& asset) {
    const std::size_t texels = std::size_t{6} * asset.cubemap_size() * asset.cubemap_size();
    for (const LightVector& light : lights.light) {
        if (light.n == asset.cubemap_size() && light.rgba.size() == 4 * texels) continue;
        return formats::make_error(formats::ErrorKind::usage, {}, "light vector",
                                   "found a cube map of " + std::to_string(light.n) +
                                       " texels and " + std::to_string(light.rgba.size()) +
                                       " floats, expected " + std::to_string(asset.cubemap_size()) +
                                       " texels as the asset",
                                   "project the environment at the asset's cube map size");
    }
    const std::size_t primitives = asset.primitives(), lit = lights.of_primitive.size();
    if (lit != 0 && lit != primitives) {
        return formats::make_error(formats::ErrorKind::usage, {}, "lights of primitives",
                                   "found " + std::to_string(lit) + ", expected one for each of " +
                                       std::to_string(primitives));
    }
    const auto is_one = [&](std::uint32_t number) { return number < lights.light.size(); };
    if (!is_one(lights.of_volumes) || !std::ranges::all_of(lights.of_primitive, is_one)) {
        return formats::make_error(
            formats::ErrorKind::usage, {}, "lights of primitives",
            "found one beyond the last of " + std::to_string(lights.light.size()) + " lights");
    }
    return formats::ok_status();
}

}  // namespace

// On the heap: members refer to each other.
struct GlRelight::State {
    GlFunctions gl;
    GlNames names{gl};
    Relight relight{gl};

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { names.release(); }
};

GlRelight::GlRelight(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlRelight::GlRelight(GlRelight&& other) noexcept = default;
GlRelight& GlRelight::operator=(GlRelight&& other) noexcept = default;
GlRelight::~GlRelight() = default;

formats::Result<GlRelight> GlRelight::create(const formats::AssetView& asset,
                                             const RelightOptions& options) {
    GlFunctions gl;
    if (const auto status = as_status(load_gl_functions(EglContext::load_function, gl)); !status) {
        return status.error();
    }
    auto state = std::make_unique<State>();
    state->gl = gl;
    const SavedState saved(gl);
    opaline_status status = state->relight.upload(asset, options, state->names);
    if (status == OPALINE_OK) status = check_errors(gl, "uploading transport");
    if (const auto made = as_status(status); !made) return made.error();
    return GlRelight(std::move(state));
}

formats::Status GlRelight::light(const PartLights& lights) {
    if (auto status = check_lights(lights, state_->relight); !status) return status;
    const SavedState saved(state_->gl);
    state_->relight.light(lights, state_->names);
    return as_status(check_errors(state_->gl, "uploading the light"));
}

formats::Status GlRelight::dot(const EmitterLight& emitters) {
    const SavedState saved(state_->gl);
    state_->relight.dot(emitters);
    return as_status(check_errors(state_->gl, "computing dot products"));
}

formats::Status GlRelight::view(formats::Vec3 eye, formats::TermSet terms) {
    if (!state_->relight.needs_eye()) return formats::ok_status();
    const SavedState saved(state_->gl);
    state_->relight.view(eye, terms);
    return as_status(check_errors(state_->gl, "adding up view terms"));
}

const Relight& GlRelight::relight() const {
    return state_->relight;
}

std::size_t GlRelight::resident() const {
    return state_->names.resident();
}

}  // namespace opaline::runtime
