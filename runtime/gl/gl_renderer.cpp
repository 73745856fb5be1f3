#include "runtime/gl/gl_renderer.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "formats/opal/rgb.h"
#include "runtime/emitter_light.h"
#include "runtime/gl/egl_context.h"
#include "runtime/gl/gl_draw.h"
#include "runtime/gl/gl_layer_pass.h"
#include "runtime/gl/gl_scene.h"
#include "runtime/gl/gl_volume_pass.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/specular.h"

namespace opaline::runtime {
namespace {

using formats::ErrorKind;
using formats::make_error;
using formats::Rgb;

// What the surface of each primitive sends out by itself, without its image; empty where there are
// no emitters.
std::vector<Rgb> own_radiances(const formats::AssetView& asset, const EmitterLight& light) {
    std::vector<Rgb> own;
    if (asset.emitters.own.empty()) return own;
    own.reserve(asset.primitives.size());
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        own.push_back(own_radiance(asset.emitters, light, p));
    }
    return own;
}

formats::Status check_lights(const PartLights& lights, const formats::AssetView& asset) {
    const std::size_t texels = std::size_t{6} * asset.cubemap_size * asset.cubemap_size;
    for (const LightVector& light : lights.light) {
        if (light.n == asset.cubemap_size && light.rgba.size() == 4 * texels) continue;
        return make_error(ErrorKind::usage, {}, "light vector",
                          "found a cube map of " + std::to_string(light.n) + " texels and " +
                              std::to_string(light.rgba.size()) + " floats, expected " +
                              std::to_string(asset.cubemap_size) + " texels as the asset",
                          "project the environment at the asset's cube map size");
    }
    const std::size_t primitives = asset.primitives.size(), lit = lights.of_primitive.size();
    if (lit != 0 && lit != primitives) {
        return make_error(ErrorKind::usage, {}, "lights of primitives",
                          "found " + std::to_string(lit) + ", expected one for each of " +
                              std::to_string(primitives));
    }
    const auto is_one = [&](std::uint32_t number) { return number < lights.light.size(); };
    if (!is_one(lights.of_volumes) || !std::ranges::all_of(lights.of_primitive, is_one)) {
        return make_error(
            ErrorKind::usage, {}, "lights of primitives",
            "found one beyond the last of " + std::to_string(lights.light.size()) + " lights");
    }
    return formats::ok_status();
}

// Seconds since it was made or last asked, all GL commands so far included.
class GlClock {
  public:
    double lap() {
        glFinish();
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// What lives on the GPU, to be destroyed while the context is current.
struct Resources {
    GlAsset gl;
    GlEnvironment environment;
    DrawPrograms draw_programs;

    ~Resources() { gl.names.release(); }
};

formats::Status compile_layers(GlAsset& gl, const LayerKind& kind, DrawPrograms& programs) {
    const bool has_volumes = gl.volumes.size() > 0;
    const auto layers = make_layer_programs(gl.names, kind, has_volumes);
    if (!layers) return layers.error();
    if (has_volumes) {
        const auto volumes = make_volume_program(gl.names, gl.volumes.objects(), true);
        if (!volumes) return volumes.error();
        programs.volumes_around_layer = *volumes;
    }
    programs.layers = *layers;
    return formats::ok_status();
}

std::uint32_t largest_target() {
    GLint texture = 0, viewport[2] = {};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    return static_cast<std::uint32_t>(std::max(1, std::min({texture, viewport[0], viewport[1]})));
}

}  // namespace

struct GlRenderer::State {
    State(EglContext made, const formats::AssetView& of) : context(std::move(made)), asset(of) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        const CurrentContext current(context);
        // Without its context nothing can be deleted by name; it takes its objects along.
        if (!current.status()) return;
        resources.reset();
    }

    EglContext context;
    formats::AssetView asset;
    std::optional<Resources> resources;
    GlVolumeLight volumes{asset.volumes, {}, {}, true, formats::TermSet::none};
    std::vector<LayerSun> layer_suns;
    Rotation rotation;
    bool mirrors_world = false;  // GlOptions::mirrored was given
    GlStats stats;
    std::vector<Rgb> own;  ///< own_radiances of the last set_light
};

GlRenderer::GlRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlRenderer::GlRenderer(GlRenderer&& other) noexcept = default;
GlRenderer& GlRenderer::operator=(GlRenderer&& other) noexcept = default;
GlRenderer::~GlRenderer() = default;

formats::Result<GlRenderer> GlRenderer::create(const formats::AssetView& asset,
                                               const formats::Environment& environment,
                                               const GlOptions& options) {
    if (options.lanes_per_row > 32 ||
        (options.lanes_per_row != 0 && !std::has_single_bit(options.lanes_per_row))) {
        return make_error(ErrorKind::usage, {}, "lanes per row",
                          "found " + std::to_string(options.lanes_per_row) +
                              ", expected a power of two up to 32, or 0");
    }
    auto context = EglContext::create();
    if (!context) return context.error();
    auto state = std::make_unique<State>(std::move(context).value(), asset);
    const CurrentContext current(state->context);
    if (auto status = current.status(); !status) return status.error();

    GlClock clock;
    GlFunctions functions;
    if (auto status = as_status(load_gl_functions(EglContext::load_function, functions)); !status) {
        return status.error();
    }
    Resources& resources = state->resources.emplace();
    GlAsset& gl = resources.gl;
    gl.gl = functions;
    constexpr std::uint32_t kFlags =
        OPALINE_GL_WITH_MESH | OPALINE_GL_WITH_IMAGES | OPALINE_GL_WITH_VOLUMES;
    if (auto status =
            as_status(gl.upload(asset, kFlags, {options.lanes_per_row, options.max_block_bytes}));
        !status) {
        return status.error();
    }
    const auto uploaded = upload_environment(environment, gl.gl, gl.names);
    if (!uploaded) return uploaded.error();
    resources.environment = *uploaded;
    state->stats.upload_seconds = clock.lap();
    state->mirrors_world = options.mirrored != nullptr;
    gl.mirror(make_specular_light(state->mirrors_world ? *options.mirrored : environment,
                                  specular_needs(asset), {}, 0));
    if (auto status = check_gl(gl.gl, "uploading specular light"); !status) return status.error();
    state->stats.specular_seconds = clock.lap();

    auto draw_programs = make_draw_programs(asset, gl);
    if (!draw_programs) return draw_programs.error();
    resources.draw_programs = std::move(draw_programs).value();
    state->stats.gpu_bytes = resident_bytes(gl.names);
    state->stats.dispatches = static_cast<std::uint32_t>(gl.relight.dispatches());
    state->stats.lanes_per_row = gl.relight.lanes_per_row();
    state->stats.device = state->context.description();
    return GlRenderer(std::move(state));
}

formats::Status GlRenderer::set_light(const PartLights& lights, const Rotation& rotation,
                                      const EmitterLight& emitters) {
    GlAsset& gl = state_->resources->gl;
    const CurrentContext current(state_->context);
    if (auto status = current.status(); !status) return status;
    if (auto status = check_lights(lights, state_->asset); !status) return status;

    GlClock clock;
    gl.relight.light(lights, gl.names);
    state_->stats.light_seconds = clock.lap();
    gl.relight.dot(emitters);
    gl.images.relight(lights, gl.primitives);
    state_->own = own_radiances(state_->asset, emitters);
    if (auto status = relight_gl_volumes(state_->volumes, gl.volumes,
                                         lights.light[lights.of_volumes], emitters);
        !status) {
        return status;
    }
    state_->stats.dot_seconds = clock.lap();
    state_->rotation = rotation;
    gl.mirrored.turn(state_->mirrors_world ? Rotation{} : rotation);
    state_->stats.gpu_bytes = resident_bytes(gl.names);
    return check_gl(gl.gl, "computing dot products");
}

formats::Status GlRenderer::set_layers(const LayerLight& light) {
    const CurrentContext current(state_->context);
    if (auto status = current.status(); !status) return status;
    GlAsset& gl = state_->resources->gl;
    DrawPrograms& programs = state_->resources->draw_programs;
    if (programs.layers.see == 0) {
        if (auto status = compile_layers(gl, layer_kind(light), programs); !status) return status;
    }
    if (auto status = as_status(gl.layer.show(light, {}, gl.names)); !status) return status;
    state_->layer_suns = light.sky.suns;
    state_->stats.gpu_bytes = resident_bytes(gl.names);
    return check_gl(gl.gl, "uploading the light of a cloud layer");
}

formats::Result<Picture> GlRenderer::render(const Camera& camera, const GlRenderOptions& options) {
    if (auto status = check_camera(camera, options.supersampling); !status) return status.error();
    const CurrentContext current(state_->context);
    if (auto status = current.status(); !status) return status.error();

    GlClock clock;
    state_->stats.draw_seconds = state_->stats.readback_seconds = 0;
    Resources& resources = *state_->resources;
    const std::uint32_t s = options.supersampling;
    const std::uint32_t side =
        std::max(1u, std::min(options.max_tile_samples, largest_target()) / s);
    GlAsset& gl = resources.gl;
    const auto target =
        make_draw_target(gl.gl, std::min(side, camera.width), std::min(side, camera.height), s,
                         {gl.layer.is_shown(), gl.volumes.size() > 0});
    if (!target) return target.error();

    auto picture = make_picture(camera.width, camera.height);
    if (!picture) return picture;
    gl.relight.view(camera.eye, options.terms);
    if (auto status = show_volume_terms(state_->volumes, gl.volumes, options.terms); !status) {
        return status.error();
    }
    gl.volumes.look_from(camera.eye, view_unit(camera));
    gl.layer.look_from(camera.eye);
    const DrawScene scene{state_->asset,
                          gl,
                          resources.environment,
                          state_->rotation,
                          camera,
                          s,
                          options.terms,
                          options.background,
                          state_->own,
                          state_->layer_suns};
    for (std::uint32_t y = 0; y < camera.height; y += side) {
        for (std::uint32_t x = 0; x < camera.width; x += side) {
            if (options.stop != nullptr && options.stop->load()) {
                return make_error(ErrorKind::interrupted, {}, "picture", "given up");
            }
            const Tile tile{x, y, std::min(side, camera.width - x),
                            std::min(side, camera.height - y)};
            draw_tile(scene, resources.draw_programs, *target, tile);
            state_->stats.draw_seconds += clock.lap();
            read_tile(*target, tile, *picture);
            state_->stats.readback_seconds += clock.lap();
        }
    }
    if (auto status = check_gl(gl.gl, "drawing"); !status) return status.error();
    return picture;
}

formats::Result<std::vector<formats::Rgb>> GlRenderer::read_radiance() {
    const CurrentContext current(state_->context);
    if (auto status = current.status(); !status) return status.error();
    const GlAsset& gl = state_->resources->gl;
    std::vector<float> padded(std::size_t{gl.relight.vertices()} * 4);
    if (!padded.empty()) {
        glGetNamedBufferSubData(gl.relight.radiance(), 0,
                                static_cast<GLsizeiptr>(padded.size() * sizeof(float)),
                                padded.data());
    }
    if (auto status = check_gl(gl.gl, "reading radiance"); !status) return status.error();
    std::vector<formats::Rgb> radiance(gl.relight.vertices());
    for (std::size_t v = 0; v < radiance.size(); ++v) {
        radiance[v] = {padded[4 * v], padded[4 * v + 1], padded[4 * v + 2]};
    }
    return radiance;
}

const GlStats& GlRenderer::stats() const {
    return state_->stats;
}

}  // namespace opaline::runtime
