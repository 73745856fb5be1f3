#include "bake/cli/draw_frames.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "bake/base/stage_log.h"
#include "bake/cli/messages.h"
#include "bake/cli/outputs.h"
#include "bake/cli/progress.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/picture/tone_map.h"
#include "runtime/shade.h"
#include "runtime/volumes/relight_volumes.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;

// Of all frames; `meter(camera)` draws the picture that it is chosen from.
template <class Meter>
void choose_exposure(const FrameOptions& options, const runtime::Camera& camera, Drawing& drawing,
                     Meter&& meter) {
    if (options.exposure || ending_of(options.output) == ".exr") {
        drawing.exposure = options.exposure.value_or(0.0f);
        return;
    }
    drawing.exposure = note_exposure(require(meter(runtime::meter_camera(camera))));
}

// Draws and writes with `draw(camera)`, exposed as `meter(camera)` asks for.
template <class Draw, class Meter>
void write_frames(const FrameOptions& options, const runtime::Camera& camera, std::uint32_t end,
                  Drawing& drawing, Draw&& draw, Meter&& meter) {
    const std::atomic<bool>& interrupted = catch_interrupts();
    if (!drawing.exposure) choose_exposure(options, camera, drawing, meter);
    for (; drawing.frames < end; ++drawing.frames) {
        if (interrupted.load()) {
            refuse(make_error(ErrorKind::interrupted, "", "", "interrupted",
                              "frames written so far are whole"));
        }
        const double degrees = options.turn * drawing.frames / options.frames;
        const auto start = bake::Clock::now();
        const auto picture = draw(runtime::orbit(camera, static_cast<float>(degrees)));
        drawing.seconds += bake::seconds_since(start);
        require(write_picture(frame_path(options, drawing.frames), require(picture),
                              *drawing.exposure, options.tone_map));
        if (options.on_progress && options.frames > 1) {
            options.on_progress({"frames", drawing.frames + 1, options.frames});
        }
    }
}

// What one light shows of a file, drawn on the processor. Refers to its arguments.
class CpuFrames {
  public:
    CpuFrames(const FrameOptions& options, const formats::AssetView& view,
              const PictureLight& light, const runtime::Camera& camera, Shown shown)
        : view_(&view),
          light_(&light),
          shown_(shown),
          threads_(options.threads),
          lights_(light.parts.lights()) {
        auto start = bake::Clock::now();
        shade_for(camera.eye);
        volumes_ = runtime::relight_volumes(
            view.volumes, lights_.light[lights_.of_volumes],
            {.terms = shown.terms, .emitters = shown.emitters, .threads = options.threads});
        print_seconds(options, "dot products", bake::seconds_since(start));
        software_.volumes = &volumes_;
        software_.lights = lights_;
        software_.threads = options.threads;
        software_.background = shown.background;
        software_.emitters = shown.emitters;
        software_.layers =
            shown.background && light.layers.layers ? &*light.layers.layers : nullptr;
        if (const runtime::SpecularNeeds needs = runtime::specular_needs(view);
            needs.any() && has_any(shown.terms, formats::TermSet::specular)) {
            start = bake::Clock::now();
            const OpenedLight mirrored = light.layers.mirrored(light.sky);
            lobes_ = runtime::make_specular_light(mirrored.environment, needs, mirrored.rotation,
                                                  options.threads);
            software_.specular = &lobes_;
            print_seconds(options, "mirrored light", bake::seconds_since(start));
        }
        depends_on_eye_ = std::ranges::any_of(view.primitives, [](const auto& primitive) {
            return primitive.shading != formats::Shading::diffuse;
        });
    }
    CpuFrames(const CpuFrames&) = delete;
    CpuFrames& operator=(const CpuFrames&) = delete;

    formats::Result<runtime::Picture> draw(const runtime::Camera& at) {
        return draw_with(at, software_);
    }
    formats::Result<runtime::Picture> meter(const runtime::Camera& at) {
        runtime::SoftwareOptions metering = software_;
        metering.supersampling = 1;
        metering.background = shown_.background && !view_->clouds.empty();
        return draw_with(at, metering);
    }

  private:
    void shade_for(formats::Vec3 eye) {
        shaded_for_ = eye;
        radiance_ = runtime::shade_for_picture(*view_, lights_, eye, shown_.terms, threads_,
                                               shown_.emitters);
    }
    formats::Result<runtime::Picture> draw_with(const runtime::Camera& at,
                                                const runtime::SoftwareOptions& how) {
        if (depends_on_eye_ && shaded_for_ != at.eye) shade_for(at.eye);
        return runtime::render_software(*view_, radiance_, light_->sky.environment,
                                        light_->sky.rotation, at, how);
    }

    const formats::AssetView* view_;
    const PictureLight* light_;
    Shown shown_;
    unsigned threads_;
    runtime::PartLights lights_;
    formats::Vec3 shaded_for_;
    std::vector<formats::Rgb> radiance_;
    runtime::VolumeLight volumes_;
    runtime::SpecularLight lobes_;
    runtime::SoftwareOptions software_;
    bool depends_on_eye_ = false;
};

void draw_on_cpu(const FrameOptions& options, const formats::AssetView& view,
                 const PictureLight& light, const runtime::Camera& camera, Shown shown,
                 std::uint32_t end, Drawing& drawing) {
    CpuFrames frames(options, view, light, camera, shown);
    write_frames(
        options, camera, end, drawing, [&](const runtime::Camera& at) { return frames.draw(at); },
        [&](const runtime::Camera& at) { return frames.meter(at); });
}

void draw_on_gpu([[maybe_unused]] const FrameOptions& options,
                 [[maybe_unused]] const formats::AssetView& view,
                 [[maybe_unused]] const PictureLight& light,
                 [[maybe_unused]] const runtime::Camera& camera, [[maybe_unused]] Shown shown,
                 [[maybe_unused]] std::uint32_t end, [[maybe_unused]] Drawing& drawing) {
#ifdef OPALINE_HAS_GL
    const bool is_first = !drawing.renderer;
    const auto prepared = prepare_renderer(view, light, drawing.renderer);
    if (!prepared && options.backend == Backend::automatic && drawing.frames == 0) {
        drawing.lacks_gl = true;
        print_note("opaline: drawing on the CPU, as OpenGL cannot be used: " +
                   printable(prepared.error().diagnostics.front().fault));
        return draw_on_cpu(options, view, light, camera, shown, end, drawing);
    }
    if (!prepared) {
        formats::Error error = prepared.error();
        error.diagnostics.front().remedy = "use --backend cpu";
        refuse(std::move(error));
    }
    runtime::GlRenderer& renderer = *drawing.renderer;
    require(light_renderer(light, shown, renderer));
    if (options.stats && is_first) {
        fmt::print("{:<16} {}\n", "device", renderer.stats().device);
        print_seconds(options, "upload", renderer.stats().upload_seconds);
        print_seconds(options, "mirrored light", renderer.stats().specular_seconds);
    }
    print_seconds(options, "light upload", renderer.stats().light_seconds);
    print_seconds(options, "dot products", renderer.stats().dot_seconds);
    runtime::GlRenderOptions gl;
    gl.terms = shown.terms;
    gl.background = shown.background;
    runtime::GlRenderOptions metering = gl;
    metering.supersampling = 1;
    metering.background = shown.background && !view.clouds.empty();
    write_frames(
        options, camera, end, drawing,
        [&](const runtime::Camera& at) { return renderer.render(at, gl); },
        [&](const runtime::Camera& at) { return renderer.render(at, metering); });
#else
    if (options.backend == Backend::automatic) {
        return draw_on_cpu(options, view, light, camera, shown, end, drawing);
    }
    refuse(make_error(ErrorKind::resource, "", "--backend", "this program was built without OpenGL",
                      "use --backend cpu"));
#endif
}

}  // namespace

float note_exposure(const runtime::Picture& metered) {
    const float exposure = runtime::choose_exposure(metered);
    if (exposure != 0) print_note(fmt::format("exposure {:+.2f} EV; --exposure sets it", exposure));
    return exposure;
}

#ifdef OPALINE_HAS_GL
formats::Status prepare_renderer(const formats::AssetView& view, const PictureLight& light,
                                 std::optional<runtime::GlRenderer>& renderer) {
    if (renderer && !(light.layers.parts && runtime::specular_needs(view).any())) {
        return formats::ok_status();
    }
    runtime::GlOptions upload;
    if (light.layers.parts) upload.mirrored = &light.layers.parts->mirrored();
    renderer.reset();  // its memory first
    auto made = runtime::GlRenderer::create(view, light.sky.environment, upload);
    if (!made) return made.error();
    renderer.emplace(std::move(*made));
    return formats::ok_status();
}

formats::Status light_renderer(const PictureLight& light, const Shown& shown,
                               runtime::GlRenderer& renderer) {
    auto status = renderer.set_light(light.parts.lights(), light.sky.rotation, shown.emitters);
    return status && shown.background && light.layers.layers
               ? renderer.set_layers(*light.layers.layers)
               : status;
}
#endif

std::string frame_path(const FrameOptions& options, std::uint32_t frame) {
    if (options.frames == 1) return options.output;
    const std::filesystem::path path(options.output);
    return (path.parent_path() /
            fmt::format("{}-{:04}{}", path.stem().string(), frame + 1, path.extension().string()))
        .string();
}

Shown show_terms(formats::TermSet terms, const formats::AssetView& view,
                 std::span<const formats::Rgb> emitters) {
    constexpr formats::TermSet kOfVolumes =
        formats::TermSet::volume_single | formats::TermSet::volume_multiple;
    const formats::TermSet possible =
        view.volumes.empty() ? formats::TermSet::baked & ~kOfVolumes : formats::TermSet::baked;
    const bool shows_all = has_all(terms, possible);
    return {terms, shows_all, {emitters, shows_all}};
}

float meter_exposure(const formats::AssetView& view, const PictureLight& light,
                     const runtime::Camera& camera, Shown shown, unsigned threads) {
    FrameOptions options;
    options.threads = threads;
    return note_exposure(require(
        CpuFrames(options, view, light, camera, shown).meter(runtime::meter_camera(camera))));
}

void print_seconds(const FrameOptions& options, const char* name, double seconds) {
    if (options.stats) {
        fmt::print("{:<16} {}\n", name, format_seconds(seconds));
    }
}

void draw_frames(const FrameOptions& options, const formats::AssetView& view,
                 const PictureLight& light, const runtime::Camera& camera, Shown shown,
                 std::uint32_t end, Drawing& drawing) {
    const bool on_cpu = options.backend == Backend::cpu || drawing.lacks_gl;
    return (on_cpu ? draw_on_cpu : draw_on_gpu)(options, view, light, camera, shown, end, drawing);
}

}  // namespace opaline::cli
