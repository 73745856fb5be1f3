#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "formats/opal/result.h"
#include "formats/opal/rgb.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/emitter_light.h"
#include "runtime/light_vector.h"
#include "runtime/part_lights.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/picture.h"
#include "runtime/specular.h"
#include "runtime/volumes/relight_volumes.h"

namespace opaline::runtime {

struct SoftwareOptions {
    std::uint32_t supersampling = 3;  ///< S: S x S samples a pixel, box filter; in [1, 8]
    unsigned threads = 0;             ///< 0: all cores; the result has the same bits for any number
    /// Light for specular reflections, of the same environment and rotation; nothing: none.
    const SpecularLight* specular = nullptr;
    bool background = true;  ///< false: black where no triangle is seen
    /// The asset's volumes under the light (relight_volumes); nothing: none are drawn.
    const VolumeLight* volumes = nullptr;
    /// The asset's cloud layer under the light (light_layers); nothing: none is drawn.
    const LayerLight* layers = nullptr;
    /// The light of `radiance`, for diffuse surfaces with normal maps (turned_light.h); nothing:
    /// those show them in what they mirror alone.
    std::optional<PartLights> lights = std::nullopt;
    /// Of the asset's emitters: what surfaces send out by themselves. Their light on other surfaces
    /// is part of `radiance`.
    EmitterLight emitters = {};
};

/// A picture of the asset in front of its environment, on the CPU.
///
/// `radiance`: of each vertex <T_0, L> per band, outgoing radiance without base colour; of
/// translucent vertices sum_k h_k(w_o') <T_k, L> toward the camera's eye (`shade` with `base_color`
/// and `fresnel` false and that eye). It is interpolated with perspective correction, like base
/// colour, normal and openness; each sample is then shaded as surface.h says, with images sampled
/// bilinearly, and with the normal of its map where it has one (turned_light.h). Triangles show
/// from both sides; diffuse ones are shaded alike, translucent and glossy ones face away with one
/// of them unless they are double-sided. Where no triangle is seen stands the radiance of the
/// environment, turned by `rotation` like the light. Volumes are marched up to what a sample sees
/// (volume_pass.h), before a black background too. A cloud layer stands with its ground between the
/// eye and that (layer_pass.h). Depth and clipping: what is nearest, from the near plane on.
/// Passes: picture.h.
///
/// Errors: usage (see check_camera; not one value per vertex or volume), resource (memory).
formats::Result<Picture> render_software(const formats::AssetView& asset,
                                         std::span<const formats::Rgb> radiance,
                                         const formats::Environment& environment,
                                         const Rotation& rotation, const Camera& camera,
                                         const SoftwareOptions& options = {});

}  // namespace opaline::runtime
