#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "bake/cli/camera_options.h"
#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/interrupt.h"
#include "bake/cli/light_with_layers.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/write_picture.h"
#include "formats/opal/terms.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/shade.h"
#include "runtime/volumes/relight_volumes.h"
#ifdef OPALINE_HAS_GL
#include "runtime/gl/gl_renderer.h"
#endif

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;
using formats::Result;
using formats::Status;
using Clock = std::chrono::steady_clock;

/// `automatic`: OpenGL, and the processor where there is none.
enum class Backend { automatic, gl, cpu };

struct RenderCommand {
    std::string path, light, output, terms;
    Backend backend = Backend::automatic;
    CameraOptions camera;
    float exposure = 0;
    double rotate_light = 0;
    double time = 0;  ///< [s]
    std::uint32_t frames = 1;
    unsigned threads = 0;
    bool stats = false;
};

// Parts of the picture to show.
struct Shown {
    formats::TermSet terms = formats::TermSet::baked;
    bool background = true;
};

// The background, cloud layers too, belongs to the whole light: to all components that the file may
// have.
Shown show(formats::TermSet terms, const formats::AssetView& view) {
    constexpr formats::TermSet kOfVolumes =
        formats::TermSet::volume_single | formats::TermSet::volume_multiple;
    const formats::TermSet possible =
        view.volumes.empty() ? formats::TermSet::baked & ~kOfVolumes : formats::TermSet::baked;
    return {terms, has_all(terms, possible)};
}

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// OUT.png, or OUT-0001.png and so on for a turntable.
std::string frame_path(const RenderCommand& options, std::uint32_t frame) {
    if (options.frames == 1) {
        return options.output;
    }
    const std::filesystem::path path(options.output);
    return (path.parent_path() /
            fmt::format("{}-{:04}{}", path.stem().string(), frame + 1, path.extension().string()))
        .string();
}

// Draws every frame of a turntable with `draw(camera)` and writes it.
template <class Draw>
int render_frames(const RenderCommand& options, const runtime::Camera& camera, Draw&& draw) {
    const std::atomic<bool>& interrupted = catch_interrupts();
    double draw_seconds = 0;
    for (std::uint32_t frame = 0; frame < options.frames; ++frame) {
        if (interrupted.load()) {
            return report_error(make_error(ErrorKind::interrupted, "", "", "interrupted",
                                           "frames written so far are whole"));
        }
        const float degrees =
            360.0f * static_cast<float>(frame) / static_cast<float>(options.frames);
        const auto start = Clock::now();
        const auto picture = draw(runtime::orbit(camera, degrees));
        draw_seconds += seconds_since(start);
        if (!picture) {
            return report_error(picture.error());
        }
        if (auto status = write_picture(frame_path(options, frame), *picture, options.exposure);
            !status) {
            return report_error(status.error());
        }
    }
    if (options.stats) {
        fmt::print("{:<16} {}\n", "frames", options.frames);
        fmt::print("{:<16} {}\n", "draw per frame", format_seconds(draw_seconds / options.frames));
    }
    return kExitSuccess;
}

void print_stat(const RenderCommand& options, const char* name, double seconds) {
    if (options.stats) {
        fmt::print("{:<16} {}\n", name, format_seconds(seconds));
    }
}

// The light of the sky, and what of it reaches meshes and volumes.
struct PictureLight {
    const OpenedLight& sky;
    const LightWithLayers& layers;
    PartVectors parts;

    const OpenedLight& of_objects() const { return layers.of_objects(sky); }
};

int render_on_cpu(const RenderCommand& options, const formats::AssetView& view,
                  const PictureLight& light, const runtime::Camera& camera, Shown shown) {
    formats::Vec3 shaded_for = camera.eye;
    const runtime::PartLights lights = light.parts.lights();
    auto start = Clock::now();
    std::vector<formats::Rgb> radiance =
        runtime::shade_for_picture(view, lights, shaded_for, shown.terms, options.threads);
    const runtime::VolumeLight volumes =
        runtime::relight_volumes(view.volumes, lights.light[lights.of_volumes],
                                 {.terms = shown.terms, .threads = options.threads});
    print_stat(options, "dot products", seconds_since(start));
    runtime::SoftwareOptions software;
    software.volumes = &volumes;
    software.threads = options.threads;
    software.background = shown.background;
    software.layers = shown.background && light.layers.layers ? &*light.layers.layers : nullptr;
    runtime::SpecularLight specular;
    if (const runtime::SpecularNeeds needs = runtime::specular_needs(view);
        needs.any() && has_any(shown.terms, formats::TermSet::specular)) {
        start = Clock::now();
        specular = runtime::make_specular_light(light.of_objects().environment, needs,
                                                light.of_objects().rotation, options.threads);
        software.specular = &specular;
        print_stat(options, "mirrored light", seconds_since(start));
    }
    const bool depends_on_eye = std::ranges::any_of(view.primitives, [](const auto& primitive) {
        return primitive.shading != formats::Shading::diffuse;
    });
    return render_frames(options, camera, [&](const runtime::Camera& at) {
        if (depends_on_eye && shaded_for != at.eye) {
            shaded_for = at.eye;
            radiance =
                runtime::shade_for_picture(view, lights, shaded_for, shown.terms, options.threads);
        }
        return runtime::render_software(view, radiance, light.sky.environment, light.sky.rotation,
                                        at, software);
    });
}

int render_on_gpu([[maybe_unused]] const RenderCommand& options,
                  [[maybe_unused]] const formats::AssetView& view,
                  [[maybe_unused]] const PictureLight& light,
                  [[maybe_unused]] const runtime::Camera& camera, [[maybe_unused]] Shown shown) {
#ifdef OPALINE_HAS_GL
    runtime::GlOptions upload;
    if (light.layers.objects) upload.mirrored = &light.layers.objects->environment;
    auto renderer = runtime::GlRenderer::create(view, light.sky.environment, upload);
    if (!renderer && options.backend == Backend::automatic) {
        print_note("opaline: drawing on the CPU, as OpenGL cannot be used: " +
                   printable(renderer.error().diagnostics.front().fault));
        return render_on_cpu(options, view, light, camera, shown);
    }
    if (!renderer) {
        formats::Error error = renderer.error();
        error.diagnostics.front().remedy = "use --backend cpu";
        return report_error(error);
    }
    if (auto status = renderer->set_light(light.parts.lights(), light.sky.rotation); !status) {
        return report_error(status.error());
    }
    if (shown.background && light.layers.layers) {
        if (auto status = renderer->set_layers(*light.layers.layers); !status) {
            return report_error(status.error());
        }
    }
    if (options.stats) {
        fmt::print("{:<16} {}\n", "device", renderer->stats().device);
    }
    print_stat(options, "upload", renderer->stats().upload_seconds);
    print_stat(options, "mirrored light", renderer->stats().specular_seconds);
    print_stat(options, "light upload", renderer->stats().light_seconds);
    print_stat(options, "dot products", renderer->stats().dot_seconds);
    runtime::GlRenderOptions drawing;
    drawing.terms = shown.terms;
    drawing.background = shown.background;
    return render_frames(options, camera,
                         [&](const runtime::Camera& at) { return renderer->render(at, drawing); });
#else
    if (options.backend == Backend::automatic) {
        return render_on_cpu(options, view, light, camera, shown);
    }
    return report_error(make_error(ErrorKind::resource, "", "--backend",
                                   "this program was built without OpenGL", "use --backend cpu"));
#endif
}

int run(const RenderCommand& options) {
    std::vector<OutputFile> outputs;
    for (std::uint32_t frame = 0; frame < options.frames; ++frame) {
        outputs.push_back({"--output", frame_path(options, frame), {".png", ".exr"}});
    }
    const std::filesystem::path inputs[] = {options.path, options.light};
    if (auto status = check_outputs(outputs, inputs); !status) {
        return report_error(status.error());
    }
    const auto terms = formats::parse_terms(options.terms, formats::TermSet::baked, "--terms");
    if (!terms) {
        return report_error(terms.error());
    }
    const auto asset = open_asset(options.path);
    if (!asset) {
        return report_error(asset.error());
    }
    if (auto status = runtime::check_terms(asset->loaded.view, *terms, options.path); !status) {
        return report_error(status.error());
    }
    const formats::AssetView& view = asset->loaded.view;
    const auto camera = make_camera(options.camera, view);
    if (!camera) {
        return report_error(camera.error());
    }
    const auto light = open_light(options.light, options.rotate_light);
    if (!light) {
        return report_error(light.error());
    }
    const LightWithLayers layers = light_layers_of(view, *light, options.time, options.threads);
    if (layers.layers) print_stat(options, "layer light", layers.seconds);
    if (options.stats && layers.objects) {
        fmt::print("{:<16} {}\n", "light points", layers.points.point.size());
    }
    // A file without rows, a cloud layer alone, needs no light vector.
    const OpenedLight none;
    const bool has_rows = !view.primitives.empty() || !view.volumes.empty();
    const auto start = Clock::now();
    const PictureLight picture_light{
        *light, layers,
        project_parts(layers, has_rows ? *light : none, view.cubemap_size, options.threads)};
    print_stat(options, "light vector", seconds_since(start));
    return (options.backend == Backend::cpu ? render_on_cpu : render_on_gpu)(
        options, view, picture_light, *camera, show(*terms, view));
}

}  // namespace

void add_render_command(CLI::App& app, Job& job) {
    auto options = std::make_shared<RenderCommand>();
    CLI::App* command = app.add_subcommand("render", "Make pictures of an .opal file, headless");
    command->add_option("file", options->path, "the .opal file")
        ->required()
        ->option_text("FILE.opal");
    command->add_option("--light", options->light, light_help())->required()->option_text("ENV");
    command
        ->add_option("-o,--output", options->output,
                     ".png: tone-mapped (Khronos PBR Neutral), sRGB; .exr: linear radiance")
        ->required()
        ->check(file_name())
        ->option_text("OUT.png|.exr");
    add_camera_options(*command, options->camera);
    command->add_option("--backend", options->backend, "gl: OpenGL 4.5 through EGL; cpu: software")
        ->transform(one_of<Backend>({{"gl", Backend::gl}, {"cpu", Backend::cpu}}))
        ->option_text("gl|cpu [gl, else cpu]");
    command
        ->add_option("--rotate-light", options->rotate_light,
                     "turn the light about +Y, from +Z toward +X [degrees]")
        ->check(real_number(-1e6, 1e6))
        ->option_text("DEG [0]");
    add_time_option(*command, options->time);
    command
        ->add_option("--frames", options->frames,
                     "a turntable: N pictures OUT-0001.png ... once around the target")
        ->transform(whole_number(1, 9999))
        ->option_text("N [1]");
    command
        ->add_option("--terms", options->terms,
                     "components to show: all, or some of " +
                         formats::term_names(formats::TermSet::baked) +
                         "; the background is black, without a cloud layer, unless all are. " +
                         formats::term_names(formats::TermSet::separable, " and ") +
                         " apart need a bake with --separate-terms")
        ->option_text("all|LIST [all]");
    command->add_option("--exposure", options->exposure, "brighter by a factor of 2^EV")
        ->check(real_number(-64, 64))
        ->option_text("EV [0]");
    command->add_option("--threads", options->threads, "0: one per core")
        ->transform(whole_number(0, 1024))
        ->option_text("T [0]");
    command->add_flag("--stats", options->stats, "print timings");
    command->footer(
        "A cloud layer lights the file's meshes and volumes as it is seen from the centre of "
        "their\n"
        "bounds, those that stand far apart from several points.\n"
        "A layer alone is seen from 1.7 m above the ground; --elevation 20 looks down on it\n"
        "from above, --azimuth 140 toward the sun of sky:T,EL.\n\n"
        "Example:\n  opaline render scene.opal --light sky:3,35 --rotate-light 90 -o scene.png");
    command->callback([options, &job] { job = [options] { return run(*options); }; });
}

}  // namespace opaline::cli
