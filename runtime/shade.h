#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/dot.h"
#include "runtime/emitter_light.h"
#include "runtime/part_lights.h"
#include "runtime/specular.h"
#include "runtime/terms.h"

namespace opaline::runtime {

struct ShadeOptions {
    unsigned threads = 0;    ///< 0: all cores; results have the same bits for any number
    bool base_color = true;  ///< false: as if every base colour were white
    DotPath path = best_dot_path();
    /// Where translucent, thin-walled and glossy receivers are seen from [m, world]; nothing: each
    /// along its own normal. Others look the same from everywhere.
    std::optional<formats::Vec3> eye = std::nullopt;
    /// false: translucent receivers without their factor Ft and with their sign, glossy opaque ones
    /// without the factor before their diffuse part. That is what a renderer interpolates, to
    /// multiply by these factors per pixel and to clamp at the end.
    bool fresnel = true;
    formats::TermSet terms = formats::TermSet::all;  ///< components to add up; see check_terms
    /// Light for specular reflections, of the same environment; nothing: none are added. Nor are
    /// they without `fresnel`: a renderer adds them per pixel.
    const SpecularLight* specular = nullptr;
    /// Light of the asset's emitters, as authored by default. What surfaces send out by themselves
    /// is added where `base_color` and `fresnel` are: renderers add it per pixel.
    EmitterLight emitters = {};
};

/// Outgoing radiance [W m^-2 sr^-1] of every receiver: L_o = base_color * <T_0, L>
/// (Shading::diffuse; Shading::sheet with the row of the side seen; with gloss times (1 - metallic)
/// (1 - max E)) or base_color * Ft * sum_k h_k(w_o') <T_k, L> (Shading::translucent), plus L_spec
/// where it is glossy (gloss_model.h, specular.h). Products <T_k, L> have the light of emitters
/// added. Each of these values is clamped to [0, largest float]; what belongs to no primitive is
/// black, and so are translucent receivers that face away or have no normal. `light`: one for all,
/// or by primitive. Preconditions: light.n == asset.cubemap_size, out.size() == asset.receivers(),
/// the asset passed read_opal's checks.
void shade(const formats::AssetView& asset, const PartLights& light, std::span<formats::Rgb> out,
           const ShadeOptions& options = {});

/// The same for receivers first .. first + out.size(), on the calling thread; never allocates.
/// `options.threads` does not matter. What receivers share with one before `first` is computed for
/// each of them.
void shade_range(const formats::AssetView& asset, const PartLights& light, std::uint32_t first,
                 std::span<formats::Rgb> out, const ShadeOptions& options = {});

/// What render_software takes: every vertex without base colour, its sign and its factor Ft left to
/// the renderer, seen from `eye`. Preconditions: as `shade`.
std::vector<formats::Rgb> shade_for_picture(const formats::AssetView& asset,
                                            const PartLights& light, formats::Vec3 eye,
                                            formats::TermSet terms, unsigned threads,
                                            const EmitterLight& emitters = {});

}  // namespace opaline::runtime
