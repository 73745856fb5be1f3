#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "runtime/gloss_light.h"
#include "runtime/light_vector.h"
#include "runtime/view_terms.h"

namespace opaline::runtime {

/// Specular reflection of distant light by translucent surfaces, for each glossy receiver
///
///     L_spec = F(c; eta) * (v * Lconv(2 c n - w_o) + (1 - v) * L_own),    F = 1 - Ft, c = n.w_o,
///
/// Lconv: the environment convolved with the lobe of the surface's roughness (SpecularLight); v:
/// the part of the lobe that is not blocked, from openness (specular_visibility); L_own: light of
/// the receiver itself before its boundary, <T, L> with view terms and base colour. White light
/// and an open receiver give F, so that with Ft <T, 1> no energy is made.
///
/// L_own stands for what blocks the lobe, which no row of the receiver knows: folds mirror their
/// own body, and other surfaces nearby stand in the same light. At silhouettes, where F is 1 and
/// Ft 0, black instead of it drew a dark line around every body on a floor.

/// The roughness of a primitive is rounded to a step of 1 / kRoughnessSteps, so that a file can
/// make a runtime hold a few maps only.
inline constexpr std::uint32_t kRoughnessSteps = 40;
/// Precondition: roughness in [0, 1].
std::uint32_t roughness_level(float roughness);
/// The levels that an asset's glossy translucent primitives use, ascending; empty where none is
/// glossy.
std::vector<std::uint32_t> roughness_levels(const formats::AssetView& asset);

/// Distant light as surfaces of some roughnesses mirror it: for each a cube map of mean radiance
/// around its directions [W m^-2 sr^-1], in the light's frame.
struct SpecularLight {
    struct Map {
        std::uint32_t level = 0;  ///< roughness * kRoughnessSteps
        formats::Environment radiance;
    };
    std::vector<Map> maps;  ///< for glossy translucent surfaces
    GlossLight gloss;       ///< for glossy opaque ones
    Rotation rotation;
    std::uint64_t id = 0;  ///< of all but the rotation: no two that were made have the same
};

/// What of a SpecularLight an asset's glossy primitives use.
struct SpecularNeeds {
    std::vector<std::uint32_t> levels;  ///< roughness_levels
    bool gloss = false;                 ///< whether an opaque primitive is glossy

    bool any() const { return gloss || !levels.empty(); }
};
SpecularNeeds specular_needs(const formats::AssetView& asset);

/// The integrals of a map over texels that its specular light is made from, in the light's frame:
/// with these kept, another sun costs no map.
struct SpecularSource {
    std::uint32_t n = 0;           ///< texels a side; 0: nothing is needed
    std::vector<double> integral;  ///< integral[3 j + band] [W m^-2], discs left out
};
SpecularSource integrate_for_specular(const formats::Environment& map, const SpecularNeeds& needs,
                                      unsigned threads);

/// Prepares what is needed, from a source made for the same needs. Same bits for any number of
/// threads (0: all cores).
SpecularLight make_specular_light(const SpecularSource& source,
                                  std::span<const formats::DistantDisc> discs,
                                  const SpecularNeeds& needs, const Rotation& rotation,
                                  unsigned threads);

/// Both.
SpecularLight make_specular_light(const formats::Environment& environment,
                                  const SpecularNeeds& needs, const Rotation& rotation,
                                  unsigned threads);

/// Lconv(r) = sum_j w_j L_j dOmega_j / sum_j w_j dOmega_j over the texels j of a cube map of 32, 64
/// or 128 texels a side, suns included; w = D(theta / 2; alpha) max(0, cos theta), theta the angle
/// to r, D the GGX distribution, alpha = roughness^2. Far from the peak, cells of
/// texels count as one (tested: within 3 % of the plain sum under a
/// sky with a lobe of 200 times its brightness). No lobe is narrower than a texel, so
/// nothing aliases, and below a roughness of about 0.1 reflections get no sharper. Values are
/// finite whatever finite light there is. Same bits for any number of threads (0: all cores).
SpecularLight prefilter_specular(const formats::Environment& environment,
                                 std::span<const std::uint32_t> levels, const Rotation& rotation,
                                 unsigned threads);

/// What a primitive's roughness means to its shader.
struct SpecularLobe {
    const formats::Environment* radiance = nullptr;  ///< nothing: no specular reflection
    float cosine = 1, sine = 0;  ///< of the half angle in which half of the lobe lies: 2 atan alpha
    bool is_glossy = false;      ///< whether the primitive mirrors anything
};
/// Its cone, without radiance; alpha below 0.05 counts as 0.05: openness resolves no sharper edge.
SpecularLobe lobe_of_alpha(float alpha);
/// Not glossy: a cone of nothing. Without `light`, or where it has no map of its level, without
/// radiance.
SpecularLobe specular_lobe(const SpecularLight* light, const formats::AssetView& asset,
                           std::size_t primitive);

/// The part of a lobe around the unit direction `mirrored` that reaches a receiver which sees the
/// fraction `open` in [0, 1] of its hemisphere around `axis`: 1 for open = 1, 0 for open = 0.
///
/// Both are taken for cones: the visible one of half angle a, sin^2 a = open, the lobe's of half
/// angle s (at least 2 atan 0.05: eight bits resolve no sharper edge). With t = smoothstep of
/// axis.mirrored between cos(a + s) and cos(a - s), times min(1, (1 - cos a) / (1 - cos s)), which
/// is about the share of the lobe inside the visible cone,
///     v = 1 - (1 - t) (1 - open^8).
/// Limits: a cone has no shape, so a wall and a pit of the same openness shadow alike.
float specular_visibility(formats::Vec3 axis, float open, formats::Vec3 mirrored,
                          const SpecularLobe& lobe);

/// What a boundary mirrors toward the eye.
struct MirroredShares {
    formats::Vec3 direction;  ///< that the lobe lies around; unit, or zero where both shares are 0
    float sky = 0, own = 0;   ///< F v and F (1 - v)
};
/// `axis` as stored (of the front side), unit or zero. The back of a double-sided primitive is as
/// open as its front. A receiver without a normal mirrors nothing. Behind a silhouette (c < 0),
/// where interpolated normals of visible points end up, it counts as mirroring at c = 0. From there
/// to c = -0.2 own light takes the place of the sky's, and fades to black at c = -0.4.
MirroredShares mirrored_shares(const SpecularLobe& lobe, const ViewOfReceiver& view, float eta,
                               formats::Vec3 axis, float open);

/// The sky's part of L_spec, finite and not negative.
formats::Rgb eval_specular(const SpecularLight& light, const SpecularLobe& lobe,
                           const ViewOfReceiver& view, float eta, formats::Vec3 axis, float open);

}  // namespace opaline::runtime
