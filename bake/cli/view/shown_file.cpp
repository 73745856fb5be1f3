#include "bake/cli/view/shown_file.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "bake/cli/draw_frames.h"
#include "bake/cli/error_map.h"
#include "bake/cli/inputs.h"
#include "bake/cli/view/coefficient_error.h"
#include "bake/encode/shorten_rows.h"
#include "formats/opal/emitters.h"
#include "runtime/distant_light.h"
#include "runtime/gl/gl_renderer.h"
#include "runtime/picture/auto_exposure.h"
#include "runtime/specular.h"
#include "runtime/terms.h"

namespace opaline::cli {
namespace {

using ViewClock = std::chrono::steady_clock;

double seconds_since(ViewClock::time_point start) {
    return std::chrono::duration<double>(ViewClock::now() - start).count();
}

double measured_error(const formats::AssetView& view) {
    const auto json = nlohmann::json::parse(view.provenance, nullptr, false);
    if (!json.is_object() || !json.contains("error") || !json["error"].is_object()) return -1;
    const auto& error = json["error"];
    return error.contains("rms_relative") && error["rms_relative"].is_number()
               ? error["rms_relative"].get<double>()
               : -1;
}

formats::TermSet terms_in(const formats::AssetView& view) {
    using formats::TermSet;
    TermSet terms = TermSet::none;
    for (const formats::PrimitiveRecord& primitive : view.primitives) {
        terms |= primitive.is_opaque() ? TermSet::diffuse : TermSet::separable;
    }
    if (runtime::specular_needs(view).any()) terms |= TermSet::specular;
    if (!view.volumes.empty()) terms |= TermSet::volume_single | TermSet::volume_multiple;
    return terms;
}

// Those of the file without which the rest can be shown.
formats::TermSet separable_terms(const formats::AssetView& view) {
    formats::TermSet found = formats::TermSet::none;
    for (std::uint32_t bit = 1; bit < static_cast<std::uint32_t>(formats::TermSet::all);
         bit <<= 1U) {
        const auto term = static_cast<formats::TermSet>(bit);
        if (has_any(terms_in(view), term) &&
            runtime::check_terms(view, formats::TermSet::baked & ~term)) {
            found |= term;
        }
    }
    return found;
}

FileFacts facts_of(const formats::AssetView& view) {
    FileFacts facts;
    facts.receivers = view.receivers();
    facts.coefficients = bake::longest_row(view);
    for (std::uint32_t e = 0; e < view.emitters.size(); ++e) {
        facts.emitters.emplace_back(view.emitters.name(e));
    }
    facts.terms = separable_terms(view);
    facts.has_layer = !view.clouds.empty();
    facts.error = measured_error(view);
    return facts;
}

}  // namespace

struct ShownFile::Parts {
    explicit Parts(OpenedAsset opened, std::string from)
        : asset(std::move(opened)),
          path(std::move(from)),
          facts(facts_of(asset.loaded.view)),
          view(asset.loaded.view) {}

    const formats::AssetView& whole() const { return asset.loaded.view; }
    std::vector<formats::Rgb> emitter_colors(const ViewState& state) const;
    formats::Status choose_rows(const ViewState& state);
    formats::Status make_renderer(const formats::Environment& map, const LightWithLayers& layers);
    PartVectors project(const LightWithLayers& layers, const OpenedLight& sky,
                        runtime::MapSampling sampling);
    formats::Status relight(const ViewState& state, const formats::Environment& map,
                            runtime::MapSampling sampling);
    formats::Status light_errors();

    OpenedAsset asset;
    std::string path;
    FileFacts facts;
    ViewSeconds seconds;
    std::vector<float> receiver_errors;  ///< empty without any
    bake::ShortRows short_rows;
    ErrorMap error_map;
    formats::AssetView view;  ///< with the coefficients that are shown, or the map of errors
    std::optional<std::uint32_t> coefficients;
    float error_white = 0;
    std::optional<runtime::GlRenderer> renderer;
    std::uint64_t light_version = 0;
    std::optional<runtime::DistantLight> light;  ///< of that version, where there is no layer
    std::optional<ViewState> lit_for;
    runtime::MapSampling lit_by = runtime::MapSampling::full;
    runtime::GlRenderOptions drawing;
    std::optional<float> exposure;  ///< of the light shown
    double error = 0;
};

std::vector<formats::Rgb> ShownFile::Parts::emitter_colors(const ViewState& state) const {
    std::vector<formats::Rgb> colors;
    colors.reserve(facts.emitters.size());
    for (const std::string& name : facts.emitters) {
        colors.push_back(emitter_color(state, name));
    }
    return colors;
}

formats::Status ShownFile::Parts::choose_rows(const ViewState& state) {
    if (state.coefficients == coefficients && state.error_white == error_white) {
        return formats::ok_status();
    }
    if (state.error_white > 0 && receiver_errors.empty()) return stored_errors(asset, path).error();
    const auto start = ViewClock::now();
    renderer.reset();
    lit_for.reset();
    view = whole();
    short_rows = {};
    error_map = {};
    if (state.error_white > 0) {
        error_map = make_error_map(whole(), receiver_errors, state.error_white);
        view = error_map.view_of(whole());
    } else if (state.coefficients && *state.coefficients < facts.coefficients) {
        auto made = bake::shorten_rows(whole(), *state.coefficients);
        if (!made) return made.error();
        short_rows = std::move(*made);
        view = short_rows.view_of(whole());
    }
    coefficients = state.coefficients;
    error_white = state.error_white;
    seconds.load = seconds_since(start);
    return formats::ok_status();
}

formats::Status ShownFile::Parts::make_renderer(const formats::Environment& map,
                                                const LightWithLayers& layers) {
    const bool mirrors_layer = layers.parts && runtime::specular_needs(view).any();
    if (renderer && !mirrors_layer) return formats::ok_status();
    runtime::GlOptions upload;
    if (layers.parts) upload.mirrored = &layers.parts->mirrored();
    renderer.reset();  // its memory first
    auto made = runtime::GlRenderer::create(view, map, upload);
    if (!made) return made.error();
    renderer.emplace(std::move(*made));
    const runtime::GlStats& stats = renderer->stats();
    seconds.upload = stats.upload_seconds + stats.specular_seconds;
    facts.device = stats.device;
    return formats::ok_status();
}

// As project_parts, but turns a light that stays instead of preparing its map anew.
PartVectors ShownFile::Parts::project(const LightWithLayers& layers, const OpenedLight& sky,
                                      runtime::MapSampling sampling) {
    const bool has_rows = !view.primitives.empty() || !view.volumes.empty();
    if (layers.parts || !has_rows) {
        return project_parts(layers, has_rows ? sky : OpenedLight{}, view.cubemap_size, 0);
    }
    if (!light) {
        light.emplace(view.cubemap_size, runtime::SpecularNeeds{});
        light->set_map(sky.environment, 0);
        for (const formats::DistantDisc& disc : sky.environment.discs) {
            light->add_sun(disc, 0);
        }
    }
    light->turn(sky.rotation, sampling, 0);
    return {{}, {light->vector()}};
}

formats::Status ShownFile::Parts::relight(const ViewState& state, const formats::Environment& map,
                                          runtime::MapSampling sampling) {
    const auto start = ViewClock::now();
    const OpenedLight sky{
        map,
        runtime::rotation_about_y(static_cast<float>(state.rotate_light * std::numbers::pi / 180))};
    const LightWithLayers layers = light_layers_of(view, sky, state.time, 0);
    const PartVectors vectors = project(layers, sky, sampling);
    seconds.light = seconds_since(start);
    const std::vector<formats::Rgb> colors = emitter_colors(state);
    const Shown shown = show_terms(state.terms, view, colors);
    // A renderer that has shown a layer goes on to do so.
    if (!view.clouds.empty() && shown.background != drawing.background) renderer.reset();
    if (auto status = make_renderer(map, layers); !status) return status;
    if (auto status = renderer->set_light(vectors.lights(), sky.rotation, shown.emitters);
        !status) {
        return status;
    }
    if (shown.background && layers.layers) {
        if (auto status = renderer->set_layers(*layers.layers); !status) return status;
    }
    seconds.dots = renderer->stats().dot_seconds;
    facts.gpu_bytes = renderer->stats().gpu_bytes;
    drawing.terms = shown.terms;
    drawing.background = shown.background;
    error = short_rows.primitives.empty()
                ? 0
                : coefficient_error_of(whole(), view, vectors.lights(), state.terms);
    return formats::ok_status();
}

// The map of errors under its own light.
formats::Status ShownFile::Parts::light_errors() {
    const OpenedLight even = error_map_light();
    if (auto status = make_renderer(even.environment, {}); !status) return status;
    const PartVectors vectors = project_parts({}, even, view.cubemap_size, 0);
    if (auto status = renderer->set_light(vectors.lights(), even.rotation); !status) return status;
    seconds.dots = renderer->stats().dot_seconds;
    facts.gpu_bytes = renderer->stats().gpu_bytes;
    drawing.terms = formats::TermSet::baked;
    drawing.background = true;
    error = 0;
    return formats::ok_status();
}

formats::Result<ShownFile> ShownFile::open(const std::string& path) {
    const auto start = ViewClock::now();
    auto asset = open_asset(path);
    if (!asset) return asset.error();
    auto errors = formats::read_receiver_errors(asset->file.bytes(), asset->loaded, path);
    if (!errors) return errors.error();
    auto parts = std::make_unique<Parts>(std::move(*asset), path);
    parts->receiver_errors = std::move(*errors);
    parts->facts.has_receiver_errors = !parts->receiver_errors.empty();
    parts->facts.receiver_errors = formats::summarize_errors(parts->receiver_errors);
    parts->seconds.load = seconds_since(start);
    return ShownFile(std::move(parts));
}

ShownFile::ShownFile(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ShownFile::ShownFile(ShownFile&&) noexcept = default;
ShownFile& ShownFile::operator=(ShownFile&&) noexcept = default;
ShownFile::~ShownFile() = default;

Viewpoint ShownFile::framing(const ViewState& state) const {
    const runtime::Camera camera =
        runtime::frame_asset(parts_->whole(), state.fov, state.width, state.height);
    return {camera.eye, camera.target, camera.up};
}

formats::Status ShownFile::follow(const ViewState& state, const formats::Environment& light,
                                  std::uint64_t light_version, runtime::MapSampling sampling) {
    Parts& parts = *parts_;
    if (auto status = runtime::check_terms(parts.whole(), state.terms, parts.path); !status) {
        return status;
    }
    if (auto status = parts.choose_rows(state); !status) return status;
    if (light_version != parts.light_version) {
        parts.renderer.reset();
        parts.light.reset();
    }
    const auto is_lit = [&](const ViewState& lit) {
        return lit.rotate_light == state.rotate_light && lit.time == state.time &&
               lit.emitters == state.emitters && lit.terms == state.terms &&
               (parts.lit_by == sampling || parts.lit_by == runtime::MapSampling::full);
    };
    if (parts.renderer && parts.lit_for && is_lit(*parts.lit_for)) return formats::ok_status();
    parts.lit_for.reset();
    parts.exposure.reset();
    if (auto status =
            state.error_white > 0 ? parts.light_errors() : parts.relight(state, light, sampling);
        !status) {
        return status;
    }
    parts.light_version = light_version;
    parts.lit_for = state;
    parts.lit_by = sampling;
    return formats::ok_status();
}

formats::Result<runtime::Picture> ShownFile::draw(runtime::Camera camera,
                                                  std::uint32_t supersampling, bool is_exact,
                                                  const std::atomic<bool>& stop) {
    camera.near_plane = runtime::near_plane_for(parts_->whole(), camera.eye);
    constexpr std::uint32_t kTile = 192;  // pixels: some dozen looks at `stop` a picture
    const runtime::GlRenderOptions usual;
    parts_->drawing.supersampling = supersampling;
    parts_->drawing.max_tile_samples = is_exact ? usual.max_tile_samples : kTile * supersampling;
    parts_->drawing.stop = &stop;
    auto picture = parts_->renderer->render(camera, parts_->drawing);
    parts_->seconds.draw = parts_->renderer->stats().draw_seconds;
    parts_->seconds.readback = parts_->renderer->stats().readback_seconds;
    return picture;
}

formats::Result<float> ShownFile::choose_exposure(runtime::Camera camera) {
    if (parts_->exposure) return *parts_->exposure;
    camera.near_plane = runtime::near_plane_for(parts_->whole(), camera.eye);
    runtime::GlRenderOptions metering = parts_->drawing;
    metering.supersampling = 1;
    metering.stop = nullptr;
    metering.background = metering.background && !parts_->view.clouds.empty();
    const auto metered = parts_->renderer->render(runtime::meter_camera(camera), metering);
    if (!metered) return metered.error();
    parts_->exposure = runtime::choose_exposure(*metered);
    return *parts_->exposure;
}

const FileFacts& ShownFile::facts() const {
    return parts_->facts;
}
const ViewSeconds& ShownFile::seconds() const {
    return parts_->seconds;
}
double ShownFile::coefficient_error() const {
    return parts_->error;
}

}  // namespace opaline::cli
