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
#include "runtime/gl/gl_asset.h"
#include "runtime/gl/gl_draw.h"
#include "runtime/gl/gl_environment.h"
#include "runtime/gl/gl_layer_pass.h"
#include "runtime/gl/gl_layers.h"
#include "runtime/gl/gl_relight.h"
#include "runtime/gl/gl_volume_pass.h"
#include "runtime/gl/gl_volumes.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/specular.h"

namespace opaline::runtime {
namespace {

using formats::ErrorKind;
using formats::make_error;
using formats::Rgb;

// What the surface of each primitive sends out by itself, without its image; empty where there are
// no emitters.
std::vector<Rgb> own_radiances(const GlAsset& asset, const EmitterLight& light) {
    std::vector<Rgb> own;
    if (asset.emitters.own.empty()) return own;
    own.reserve(asset.primitives.size());
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        own.push_back(own_radiance(asset.emitters.view(), light, p));
    }
    return own;
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
    GlRelight relight;
    GlAsset asset;
    GlEnvironment environment;
    GlSpecular specular;
    GlVolumes volumes;
    GlLayers layers;
    DrawPrograms draw_programs;
};

formats::Status compile_layers(Resources& resources) {
    const bool has_volumes = !resources.volumes.empty();
    auto layers = make_layer_programs(resources.layers, has_volumes);
    if (!layers) return layers.error();
    resources.draw_programs.layers = std::move(layers).value();
    if (!has_volumes || resources.draw_programs.volumes_around_layer.name() != 0) {
        return formats::ok_status();
    }
    auto volumes = make_volume_program(resources.volumes, true);
    if (!volumes) return volumes.error();
    resources.draw_programs.volumes_around_layer = std::move(volumes).value();
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
    explicit State(EglContext made) : context(std::move(made)) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        const CurrentContext current(context);
        // Without its context nothing can be deleted by name; it takes its objects along.
        if (!current.status()) return;
        resources.reset();
    }

    EglContext context;
    std::optional<Resources> resources;
    Rotation rotation;
    bool mirrors_world = false;  // GlOptions::mirrored was given
    GlStats stats;
    std::vector<formats::Rgb> own;  ///< own_radiances of the last set_light
    TurnedLights turned;
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
    auto state = std::make_unique<State>(std::move(context).value());
    const CurrentContext current(state->context);
    if (auto status = current.status(); !status) return status.error();

    GlClock clock;
    auto relight = GlRelight::create(asset, {options.lanes_per_row, options.max_block_bytes});
    if (!relight) return relight.error();
    auto gl_asset = upload_asset(asset, relight->relight().radiance());
    if (!gl_asset) return gl_asset.error();
    auto gl_volumes = upload_volumes(asset.volumes, relight->relight().max_block_bytes());
    if (!gl_volumes) return gl_volumes.error();
    auto gl_environment = upload_environment(environment);
    if (!gl_environment) return gl_environment.error();
    state->stats.upload_seconds = clock.lap();
    auto gl_specular = upload_specular(
        make_specular_light(options.mirrored != nullptr ? *options.mirrored : environment,
                            specular_needs(asset), {}, 0));
    if (!gl_specular) return gl_specular.error();
    state->stats.specular_seconds = clock.lap();

    auto draw_programs = make_draw_programs(*gl_asset, *gl_volumes);
    if (!draw_programs) return draw_programs.error();
    state->stats.gpu_bytes = relight->resident() + gl_asset->resident + gl_environment->resident +
                             gl_specular->resident + gl_volumes->resident;
    state->stats.dispatches = static_cast<std::uint32_t>(relight->relight().dispatches());
    state->stats.lanes_per_row = relight->relight().lanes_per_row();
    state->mirrors_world = options.mirrored != nullptr;
    state->stats.device = state->context.description();
    state->resources.emplace(Resources{std::move(*relight),
                                       std::move(*gl_asset),
                                       std::move(*gl_environment),
                                       std::move(*gl_specular),
                                       std::move(*gl_volumes),
                                       {},
                                       std::move(*draw_programs)});
    return GlRenderer(std::move(state));
}

formats::Status GlRenderer::set_light(const PartLights& lights, const Rotation& rotation,
                                      const EmitterLight& emitters) {
    Resources& resources = *state_->resources;
    const CurrentContext current(state_->context);
    if (auto status = current.status(); !status) return status;

    GlClock clock;
    if (auto status = resources.relight.light(lights); !status) return status;
    state_->stats.light_seconds = clock.lap();
    if (auto status = resources.relight.dot(emitters); !status) return status;
    state_->own = own_radiances(resources.asset, emitters);
    state_->turned =
        make_turned_lights(lights, resources.asset.primitives, resources.asset.normal_maps);
    if (auto status = relight_gl_volumes(resources.volumes, lights.light[lights.of_volumes],
                                         formats::TermSet::all, emitters);
        !status) {
        return status;
    }
    state_->stats.dot_seconds = clock.lap();
    state_->rotation = rotation;
    return check_gl("computing dot products");
}

formats::Status GlRenderer::set_layers(const LayerLight& light) {
    const CurrentContext current(state_->context);
    if (auto status = current.status(); !status) return status;
    Resources& resources = *state_->resources;
    GlLayers& layers = resources.layers;
    const std::string compiled_for = layers.defines;
    state_->stats.gpu_bytes -= layers.layer_bytes + layers.light_bytes;
    auto status = relight_gl_layers(layers, light);
    state_->stats.gpu_bytes += layers.layer_bytes + layers.light_bytes;
    if (!status) return status;
    if (layers.defines != compiled_for) {
        if (auto made = compile_layers(resources); !made) {
            layers.shown = false;
            layers.defines.clear();
            return made;
        }
    }
    return formats::ok_status();
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
    const auto target =
        make_draw_target(std::min(side, camera.width), std::min(side, camera.height), s,
                         {resources.layers.shown, !resources.volumes.empty()});
    if (!target) return target.error();

    auto picture = make_picture(camera.width, camera.height);
    if (!picture) return picture;
    if (auto status = resources.relight.view(camera.eye, options.terms); !status) {
        return status.error();
    }
    if (auto status = show_volume_terms(resources.volumes, options.terms); !status) {
        return status.error();
    }
    const DrawScene scene{resources.asset,
                          resources.environment,
                          resources.specular,
                          resources.volumes,
                          resources.layers,
                          state_->rotation,
                          state_->mirrors_world ? Rotation{} : state_->rotation,
                          camera,
                          s,
                          options.terms,
                          options.background,
                          state_->own,
                          &state_->turned};
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
    if (auto status = check_gl("drawing"); !status) return status.error();
    return picture;
}

formats::Result<std::vector<formats::Rgb>> GlRenderer::read_radiance() {
    const CurrentContext current(state_->context);
    if (auto status = current.status(); !status) return status.error();
    const GlAsset& asset = state_->resources->asset;
    std::vector<float> padded(std::size_t{asset.vertices} * 4);
    if (!padded.empty()) {
        glGetNamedBufferSubData(state_->resources->relight.relight().radiance(), 0,
                                static_cast<GLsizeiptr>(padded.size() * sizeof(float)),
                                padded.data());
    }
    if (auto status = check_gl("reading radiance"); !status) return status.error();
    std::vector<formats::Rgb> radiance(asset.vertices);
    for (std::size_t v = 0; v < radiance.size(); ++v) {
        radiance[v] = {padded[4 * v], padded[4 * v + 1], padded[4 * v + 2]};
    }
    return radiance;
}

const GlStats& GlRenderer::stats() const {
    return state_->stats;
}

}  // namespace opaline::runtime
