#include "bake/cli/view/shown_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "bake/base/stage_log.h"
#include "bake/cli/draw_frames.h"
#include "formats/opal/emitters.h"
#include "runtime/picture/tone_map.h"
#include "runtime/shade.h"
#include "runtime/specular.h"
#include "runtime/terms.h"

namespace opaline::cli {
namespace {

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

double squared_norm(formats::Rgb c) {
    const double r = static_cast<double>(c.r), g = static_cast<double>(c.g),
                 b = static_cast<double>(c.b);
    return r * r + g * g + b * b;
}

// How far an asset with fewer coefficients is from the whole one under a light: root mean square of
// the difference of outgoing radiance over that of the whole, of 4096 receivers at most, in equal
// steps. 0 without any light. Precondition: the same receivers.
double coefficient_error_of(const formats::AssetView& whole, const formats::AssetView& shortened,
                            const runtime::PartLights& light, formats::TermSet terms) {
    constexpr std::uint32_t kMost = 4096;
    const std::uint32_t step = std::max(1u, (whole.receivers() + kMost - 1) / kMost);
    runtime::ShadeOptions options;
    options.terms = terms;
    double difference = 0, sum = 0;
    for (std::uint32_t receiver = 0; receiver < whole.receivers(); receiver += step) {
        formats::Rgb all, few;
        runtime::shade_range(whole, light, receiver, {&all, 1}, options);
        runtime::shade_range(shortened, light, receiver, {&few, 1}, options);
        difference += squared_norm(all + -1.0f * few);
        sum += squared_norm(all);
    }
    return sum > 0 ? std::sqrt(difference / sum) : 0;
}

}  // namespace

std::vector<formats::Rgb> ShownFile::emitter_colors(const ViewState& state) const {
    std::vector<formats::Rgb> colors;
    colors.reserve(facts_.emitters.size());
    for (const std::string& name : facts_.emitters) {
        colors.push_back(emitter_color(state, name));
    }
    return colors;
}

formats::Status ShownFile::choose_rows(const ViewState& state) {
    if (state.coefficients == coefficients_ && state.error_white == error_white_) {
        return formats::ok_status();
    }
    if (state.error_white > 0 && receiver_errors_.empty()) {
        return stored_errors(asset_, path_).error();
    }
    const auto start = bake::Clock::now();
    renderer_.reset();
    lit_for_.reset();
    view_ = whole();
    short_rows_ = {};
    error_map_ = {};
    if (state.error_white > 0) {
        error_map_ = make_error_map(whole(), receiver_errors_, state.error_white);
        view_ = error_map_.view_of(whole());
    } else if (state.coefficients && *state.coefficients < facts_.coefficients) {
        auto made = bake::shorten_rows(whole(), *state.coefficients);
        if (!made) return made.error();
        short_rows_ = std::move(*made);
        view_ = short_rows_.view_of(whole());
    }
    coefficients_ = state.coefficients;
    error_white_ = state.error_white;
    seconds_.load = bake::seconds_since(start);
    return formats::ok_status();
}

formats::Status ShownFile::light_with(const PictureLight& light, const Shown& shown) {
    if (auto status = prepare_renderer(view_, light, renderer_); !status) return status;
    if (auto status = light_renderer(light, shown, *renderer_); !status) return status;
    const runtime::GlStats& stats = renderer_->stats();
    seconds_.upload = stats.upload_seconds + stats.specular_seconds;
    seconds_.dots = stats.dot_seconds;
    facts_.device = stats.device;
    facts_.gpu_bytes = stats.gpu_bytes;
    drawing_.terms = shown.terms;
    drawing_.background = shown.background;
    return formats::ok_status();
}

// As project_parts, but turns a light that stays instead of preparing its map anew.
PartVectors ShownFile::project(const LightWithLayers& layers, const OpenedLight& sky,
                               runtime::MapSampling sampling) {
    if (layers.parts || !has_rows(view_)) return project_parts(view_, layers, sky, 0);
    if (!light_) {
        light_.emplace(view_.cubemap_size, runtime::SpecularNeeds{});
        light_->set_map(sky.environment, 0);
        for (const formats::DistantDisc& disc : sky.environment.discs) {
            light_->add_sun(disc, 0);
        }
    }
    light_->turn(sky.rotation, sampling, 0);
    return {{}, {light_->vector()}};
}

formats::Status ShownFile::relight(const ViewState& state, const formats::Environment& map,
                                   runtime::MapSampling sampling) {
    const auto start = bake::Clock::now();
    const OpenedLight sky{
        map,
        runtime::rotation_about_y(static_cast<float>(state.rotate_light * std::numbers::pi / 180))};
    const LightWithLayers layers = light_layers_of(view_, sky, state.time, 0);
    const PictureLight light{sky, layers, project(layers, sky, sampling)};
    seconds_.light = bake::seconds_since(start);
    const std::vector<formats::Rgb> colors = emitter_colors(state);
    const Shown shown = show_terms(state.terms, view_, colors);
    // A renderer_ that has shown a layer goes on to do so.
    if (!view_.clouds.empty() && shown.background != drawing_.background) renderer_.reset();
    if (auto status = light_with(light, shown); !status) return status;
    error_ = short_rows_.primitives.empty()
                 ? 0
                 : coefficient_error_of(whole(), view_, light.parts.lights(), state.terms);
    return formats::ok_status();
}

// The map of errors under its own light_.
formats::Status ShownFile::light_errors() {
    const OpenedLight even = error_map_light();
    const LightWithLayers none;
    if (auto status = light_with({even, none, project_parts(view_, none, even, 0)}, {}); !status) {
        return status;
    }
    error_ = 0;
    return formats::ok_status();
}

formats::Result<std::unique_ptr<ShownFile>> ShownFile::open(const std::string& path) {
    const auto start = bake::Clock::now();
    auto asset = open_asset(path);
    if (!asset) return asset.error();
    auto errors = formats::read_receiver_errors(asset->file.bytes(), asset->loaded, path);
    if (!errors) return errors.error();
    auto shown = std::unique_ptr<ShownFile>(new ShownFile(std::move(*asset), path));
    shown->facts_.has_receiver_errors = !errors->empty();
    shown->facts_.receiver_errors = formats::summarize_errors(*errors);
    shown->receiver_errors_ = std::move(*errors);
    shown->seconds_.load = bake::seconds_since(start);
    return shown;
}

ShownFile::ShownFile(OpenedAsset opened, std::string path)
    : asset_(std::move(opened)),
      path_(std::move(path)),
      facts_(facts_of(asset_.loaded.view)),
      view_(asset_.loaded.view) {}

Viewpoint ShownFile::framing(const ViewState& state) const {
    const runtime::Camera camera =
        runtime::frame_asset(whole(), state.fov, state.width, state.height);
    return {camera.eye, camera.target, camera.up};
}

formats::Status ShownFile::follow(const ViewState& state, const formats::Environment& light,
                                  std::uint64_t light_version, runtime::MapSampling sampling) {
    if (auto status = runtime::check_terms(whole(), state.terms, path_); !status) {
        return status;
    }
    if (auto status = choose_rows(state); !status) return status;
    if (light_version != light_version_) {
        renderer_.reset();
        light_.reset();
    }
    const auto is_lit = [&](const ViewState& lit) {
        return lit.rotate_light == state.rotate_light && lit.time == state.time &&
               lit.emitters == state.emitters && lit.terms == state.terms &&
               (lit_by_ == sampling || lit_by_ == runtime::MapSampling::full);
    };
    if (renderer_ && lit_for_ && is_lit(*lit_for_)) return formats::ok_status();
    lit_for_.reset();
    exposure_.reset();
    if (auto status = state.error_white > 0 ? light_errors() : relight(state, light, sampling);
        !status) {
        return status;
    }
    light_version_ = light_version;
    lit_for_ = state;
    lit_by_ = sampling;
    return formats::ok_status();
}

formats::Result<runtime::Picture> ShownFile::draw(runtime::Camera camera,
                                                  std::uint32_t supersampling, bool is_exact,
                                                  const std::atomic<bool>& stop) {
    camera.near_plane = runtime::near_plane_for(whole(), camera.eye);
    constexpr std::uint32_t kTile = 192;  // pixels: some dozen looks at `stop` a picture
    const runtime::GlRenderOptions usual;
    drawing_.supersampling = supersampling;
    drawing_.max_tile_samples = is_exact ? usual.max_tile_samples : kTile * supersampling;
    drawing_.stop = &stop;
    auto picture = renderer_->render(camera, drawing_);
    seconds_.draw = renderer_->stats().draw_seconds;
    seconds_.readback = renderer_->stats().readback_seconds;
    return picture;
}

formats::Result<float> ShownFile::choose_exposure(runtime::Camera camera) {
    if (exposure_) return *exposure_;
    camera.near_plane = runtime::near_plane_for(whole(), camera.eye);
    runtime::GlRenderOptions metering = drawing_;
    metering.supersampling = 1;
    metering.stop = nullptr;
    metering.background = metering.background && !view_.clouds.empty();
    const auto metered = renderer_->render(runtime::meter_camera(camera), metering);
    if (!metered) return metered.error();
    exposure_ = runtime::choose_exposure(*metered);
    return *exposure_;
}

}  // namespace opaline::cli
