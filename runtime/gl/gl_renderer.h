#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/emitter_light.h"
#include "runtime/light_vector.h"
#include "runtime/part_lights.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/picture.h"

namespace opaline::runtime {

struct GlOptions {
    /// Invocations that share a row of the dot products: a power of two in [1, 32]. 0: 8 on
    /// software renderers (a SIMD register, measured best on llvmpipe), 16 on GPUs (half a warp).
    std::uint32_t lanes_per_row = 0;
    /// Upper bound on bytes that one dispatch may see of one buffer; 0: what the driver states.
    std::size_t max_block_bytes = 0;
    /// What surfaces mirror, in the world's frame whatever the light's rotation: for those beneath
    /// a cloud layer (clouds/environment_at.h). Nothing: the environment behind them.
    const formats::Environment* mirrored = nullptr;
};

struct GlRenderOptions {
    std::uint32_t supersampling = 3;        ///< S: S x S samples a pixel, box filter; in [1, 8]
    std::uint32_t max_tile_samples = 2048;  ///< side of the tiles drawn at once, >= S
    formats::TermSet terms = formats::TermSet::all;  ///< components to add up; see check_terms
    bool background = true;                          ///< false: black behind the asset
    /// Looked at between tiles: once true, the picture is given up (interrupted).
    const std::atomic<bool>* stop = nullptr;
};

/// Wall-clock seconds of the last upload, set_light and render; each ends with glFinish.
struct GlStats {
    double upload_seconds = 0;    ///< asset and environment to buffers and textures
    double specular_seconds = 0;  ///< environment to specular light, on the CPU, and its upload
    double light_seconds = 0;     ///< light vector to its buffer
    double dot_seconds = 0;       ///< all dot products
    double draw_seconds = 0;      ///< view terms, geometry, layers, background and box filter
    double readback_seconds = 0;
    std::size_t gpu_bytes = 0;     ///< in buffers and textures of the asset, environment and layers
    std::uint32_t dispatches = 0;  ///< of the compute shader, one per batch of rows
    std::uint32_t lanes_per_row = 0;  ///< as used
    std::string device;               ///< GL renderer and version
};

/// Pictures of an asset by OpenGL 4.5, without a window.
///
/// Owns its GL context, which is current only inside calls; the caller's context is restored. One
/// thread at a time. The same image as render_software with the same radiance and specular light,
/// up to rounding and to which sample an edge falls on. Reads the environment only in `create`; the
/// asset's bytes must outlive the renderer.
class GlRenderer {
  public:
    /// Uploads. Errors: resource (no EGL or GL, memory, or size limits, with the driver's name;
    /// more than kMaxGlVolumes volumes).
    static formats::Result<GlRenderer> create(const formats::AssetView& asset,
                                              const formats::Environment& environment,
                                              const GlOptions& options = {});

    GlRenderer(GlRenderer&& other) noexcept;
    GlRenderer& operator=(GlRenderer&& other) noexcept;
    ~GlRenderer();

    /// Computes <T_k, L> of every vertex in a compute shader, and those of the nodes of volumes on
    /// the CPU, from a copy of their rows. `rotation` turns the background; the
    /// light vectors must have been made with the same one. Errors: usage (another cube map size
    /// than the asset's, not one light for each primitive), resource.
    /// `emitters`: of the asset, a colour for each or none.
    formats::Status set_light(const PartLights& lights, const Rotation& rotation,
                              const EmitterLight& emitters = {});

    /// Shows the asset's cloud layer under this light, at its time, from the next picture on; the
    /// light must have been made with the environment of `create` and the rotation of set_light.
    /// Another time or light of the same layer is cheap: what depends on neither stays where it is.
    /// Errors: resource.
    formats::Status set_layers(const LayerLight& light);

    /// Draws and reads back; before the first set_light surfaces and volumes are black. Errors: as
    /// check_camera; resource; interrupted.
    formats::Result<Picture> render(const Camera& camera, const GlRenderOptions& options = {});

    /// Reads back <T_0, L> of every vertex, as the last set_light left it; of vertices with several
    /// rows sum_k h_k(w_o') <T_k, L> toward the eye of the last render (0 before it).
    formats::Result<std::vector<formats::Rgb>> read_radiance();

    const GlStats& stats() const;

  private:
    struct State;
    explicit GlRenderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace opaline::runtime
