#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/cli/draw_frames.h"
#include "bake/cli/error_map.h"
#include "bake/cli/inputs.h"
#include "bake/cli/view/view_state.h"
#include "bake/encode/shorten_rows.h"
#include "formats/opal/receiver_errors.h"
#include "formats/opal/result.h"
#include "runtime/distant_light.h"
#include "runtime/gl/gl_renderer.h"
#include "runtime/integrate_map.h"
#include "runtime/picture/picture.h"

namespace opaline::cli {

/// What a window says of a file.
struct FileFacts {
    std::uint32_t receivers = 0;
    std::uint32_t coefficients = 0;  ///< of the longest row of meshes
    std::vector<std::string> emitters;
    formats::TermSet terms = formats::TermSet::none;  ///< that can be left out by themselves
    bool has_layer = false;
    double error = -1;  ///< RMS relative, as the bake measured it; below 0: it did not
    bool has_receiver_errors = false;
    formats::ErrorSummary receiver_errors;
    std::string device;
    std::size_t gpu_bytes = 0;
};

/// Wall-clock seconds of what was done last.
struct ViewSeconds {
    double load = 0;  ///< the file from disk, the choice of coefficients
    double upload = 0;
    double light = 0;  ///< light vector, cloud layer
    double dots = 0;   ///< dot products of all receivers
    double draw = 0, readback = 0;
};

/// A file as a window shows it: its bytes, and a renderer that follows the state of the view. It
/// does again only what a change asks for. One thread at a time, any thread.
class ShownFile {
  public:
    /// Errors: as open_asset, and damaged errors by receiver.
    static formats::Result<std::unique_ptr<ShownFile>> open(const std::string& path);
    ShownFile(const ShownFile&) = delete;
    ShownFile& operator=(const ShownFile&) = delete;
    ~ShownFile() = default;

    /// The viewpoint that frames the file.
    Viewpoint framing(const ViewState& state) const;

    /// Follows light, time, emitters, coefficients and terms, or shows errors by receiver, of all
    /// coefficients, in place of all of these. `light_version` grows with every
    /// light that is opened. `sampling`: of a map that turns; a finer one than last time counts as
    /// a change. Errors: bad_input (terms that the file does not hold apart, no errors by
    /// receiver), resource (no OpenGL).
    formats::Status follow(const ViewState& state, const formats::Environment& light,
                           std::uint64_t light_version, runtime::MapSampling sampling);

    /// What follow() prepared, from a camera, which gets the near plane of the file. Not exact: in
    /// small tiles, so that samples at edges may differ from what `render` sees, but `stop` is
    /// looked at more often. Errors: resource; interrupted, once `stop` is true.
    formats::Result<runtime::Picture> draw(runtime::Camera camera, std::uint32_t supersampling,
                                           bool is_exact, const std::atomic<bool>& stop);

    /// What the picture asks for [EV], as that camera sees it; the same from then on, until light
    /// or what is shown changes, so that turning the camera changes no exposure. Errors: resource.
    formats::Result<float> choose_exposure(runtime::Camera camera);

    const FileFacts& facts() const { return facts_; }
    const ViewSeconds& seconds() const { return seconds_; }
    /// Of the coefficients that the state leaves, against all: root mean square of the difference
    /// of the radiance of 4096 receivers at most, relative, under the light shown. 0 with all.
    double coefficient_error() const { return error_; }

  private:
    ShownFile(OpenedAsset opened, std::string path);
    const formats::AssetView& whole() const { return asset_.loaded.view; }
    std::vector<formats::Rgb> emitter_colors(const ViewState& state) const;
    formats::Status choose_rows(const ViewState& state);
    formats::Status light_with(const PictureLight& light, const Shown& shown);
    PartVectors project(const LightWithLayers& layers, const OpenedLight& sky,
                        runtime::MapSampling sampling);
    formats::Status relight(const ViewState& state, const formats::Environment& map,
                            runtime::MapSampling sampling);
    formats::Status light_errors();

    OpenedAsset asset_;
    std::string path_;
    FileFacts facts_;
    ViewSeconds seconds_;
    std::vector<float> receiver_errors_;  ///< empty without any
    bake::ShortRows short_rows_;
    ErrorMap error_map_;
    formats::AssetView view_;  ///< with the coefficients that are shown, or the map of errors
    std::optional<std::uint32_t> coefficients_;
    float error_white_ = 0;
    std::optional<runtime::GlRenderer> renderer_;
    std::uint64_t light_version_ = 0;
    std::optional<runtime::DistantLight> light_;  ///< of that version, where there is no layer
    std::optional<ViewState> lit_for_;
    runtime::MapSampling lit_by_ = runtime::MapSampling::full;
    runtime::GlRenderOptions drawing_;
    std::optional<float> exposure_;  ///< of the light shown
    double error_ = 0;
};

}  // namespace opaline::cli
