#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "bake/base/context.h"
#include "bake/cli/inputs.h"
#include "formats/opal/asset.h"
#include "formats/opal/terms.h"
#include "runtime/emitter_light.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/picture.h"
#include "runtime/picture/tone_map.h"
#ifdef OPALINE_HAS_GL
#include "runtime/gl/gl_renderer.h"
#endif

namespace opaline::cli {

/// `automatic`: OpenGL, and the processor where there is none.
enum class Backend { automatic, gl, cpu };

/// How pictures of a file are made.
struct FrameOptions {
    std::string output;
    Backend backend = Backend::automatic;
    /// [EV]; nothing: chosen from the first frame (tone_map.h), 0 of radiance (.exr).
    std::optional<float> exposure;
    runtime::ToneMap tone_map = runtime::ToneMap::neutral;
    std::uint32_t frames = 1;  ///< 1 or more
    double turn = 360;         ///< that the camera goes around the target in all frames [degrees]
    unsigned threads = 0;
    bool stats = false;
    std::function<void(const bake::Progress&)> on_progress;  ///< of several frames; may be empty
};

/// Exposure [EV] that a metered picture asks for, with a note where it is not 0.
float note_exposure(const runtime::Picture& metered);

/// Where a frame is written: OUT.png, or OUT-0001.png and so on of several. `frame` from 0.
std::string frame_path(const FrameOptions& options, std::uint32_t frame);

/// Parts of the picture to show.
struct Shown {
    formats::TermSet terms = formats::TermSet::baked;
    bool background = true;
    /// Of the file's emitters; what glows by itself belongs to the whole light, as the background.
    runtime::EmitterLight emitters = {};
};

/// The background, cloud layers and what glows too, belongs to the whole light: to all components
/// that the file may have.
Shown show_terms(formats::TermSet terms, const formats::AssetView& view,
                 std::span<const formats::Rgb> emitters);

/// The light of the sky, and what of it reaches meshes and volumes.
struct PictureLight {
    const OpenedLight& sky;
    const LightWithLayers& layers;
    PartVectors parts;
};

/// What stays from one light to the next.
struct Drawing {
    std::uint32_t frames = 0;       ///< drawn and written so far
    std::optional<float> exposure;  ///< of all frames [EV], from the first one on
    double seconds = 0;             ///< of drawing them
    bool lacks_gl = false;          ///< OpenGL was tried, and cannot be used
#ifdef OPALINE_HAS_GL
    std::optional<runtime::GlRenderer> renderer;
#endif
};

/// Draws the frames up to `end` that are not drawn yet, and writes them. `camera`: of the first
/// frame. Throws Refusal (messages.h). The file and the sky are the same in each call.
void draw_frames(const FrameOptions& options, const formats::AssetView& view,
                 const PictureLight& light, const runtime::Camera& camera, Shown shown,
                 std::uint32_t end, Drawing& drawing);

/// The exposure that draw_frames chooses for a .png of this camera [EV], from a small picture drawn
/// on the processor, with a note where it is not 0. Throws Refusal.
float meter_exposure(const formats::AssetView& view, const PictureLight& light,
                     const runtime::Camera& camera, Shown shown, unsigned threads);

#ifdef OPALINE_HAS_GL
/// A renderer for this light: the one that there is, unless surfaces mirror what has changed.
formats::Status prepare_renderer(const formats::AssetView& view, const PictureLight& light,
                                 std::optional<runtime::GlRenderer>& renderer);
/// Gives it the light, and the layers where they are shown.
formats::Status light_renderer(const PictureLight& light, const Shown& shown,
                               runtime::GlRenderer& renderer);
#endif

/// A line of `--stats`.
void print_seconds(const FrameOptions& options, const char* name, double seconds);

}  // namespace opaline::cli
