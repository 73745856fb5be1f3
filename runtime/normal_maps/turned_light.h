#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/normal_maps.h"
#include "formats/opal/rgb.h"
#include "formats/opal/sheet_shares.h"
#include "formats/opal/vec3.h"
#include "runtime/light_vector.h"
#include "runtime/part_lights.h"
#include "runtime/view_terms.h"

namespace opaline::runtime {

/// Surfaces that are shaded with the normals of an image; shaders/surface.glsl does the same steps.

/// The unit normal that a normal map gives a point (formats/README.md, `NORM`). `normal`: unit, of
/// the front; `tangent`: interpolated, not normalised. `normal` itself where the map gives no
/// direction. Precondition: the record is of this asset.
formats::Vec3 mapped_normal(const formats::AssetView& asset, const formats::NormalMapRecord& map,
                            formats::Float2 texcoord, formats::Vec3 normal,
                            formats::DecodedTangent tangent);

/// The view of the same point with the normal `mapped`, of the front. A normal that turns away from
/// an eye which sees the surface is bent toward it, to a cosine of at least 0.05 or the surface's
/// own.
ViewOfReceiver view_mapped(const ViewOfReceiver& view, formats::Vec3 mapped);

/// What a receiver would get with another normal: its relit light, of the normal n of the vertices,
/// for the normal m of a map. Of the light's directions at the receiver nothing is stored, so those
/// of the unblocked light stand for them. With A(n) what smooth light and S(n) what suns give an
/// open white surface, both as radiance, L the relit radiance and e a small share of the mean
/// light, for each band
///
///     v  = clamp((L - A(n)) / max(S(n), e), 0, 1)      of all bands together: the share of suns
///     D  = min(L, A(n) + v S(n))                       what can have come straight
///     L' = L - D + D (A(m) + v S(m) + e) / (A(n) + v S(n) + e)
///
/// A is the expansion of irradiance in spherical harmonics up to degree 2 [Ramamoorthi2001], whose
/// error is 1 % for most maps once suns are split off. So L' = L where m = n and under even light,
/// a sun is exact on open surfaces and without effect where it does not reach, and light of
/// bounces and of emitters beyond what the sky can give stays as it is. What it errs:
/// occlusion is taken to be the same in all directions, a surface that faces away from a sun gets
/// none of it back, and light of bounces and emitters that is within what the sky can
/// give is turned with the sky's.
struct TurnedLight {
    /// A(n) = h0 + h1 y + h2 z + h3 x + h4 xy + h5 yz + h6 (3 z^2 - 1) + h7 xz + h8 (x^2 - y^2), in
    /// the world; not below 0.
    std::array<formats::Rgb, 9> harmonics{};
    struct Sun {
        formats::Vec3 direction;  ///< unit, world
        formats::Rgb light;       ///< irradiance facing it over pi
    };
    std::vector<Sun> suns;  ///< at most kMaxSuns (volumes/suns.h)
    formats::Rgb least;     ///< e: 1/64 of the mean of A + S over all normals
};

TurnedLight make_turned_light(const LightVector& light);

/// The same for a thin-walled surface that reflects r and transmits t, seen from the side of the
/// normal: with A_s(n) = r A(n) + t A(-n) and S_s(n) = r S(n) + t S(-n) in place of A and S. Both
/// are sums of what the struct holds: odd harmonics times r - t, even ones times r + t, and each
/// sun on the other side too, with t of its light. Suns beyond the brightest kMaxSuns / 2
/// directions become smooth light. Normals are those of the side that is seen.
TurnedLight turned_light_of_sheet(const TurnedLight& light, const formats::SheetShares& shares);

/// Those of an asset's primitives.
struct TurnedLights {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<TurnedLight> light;
    std::vector<std::uint32_t> of_primitive;  ///< index into `light`; kNone: nothing is turned

    const TurnedLight* of(std::size_t primitive) const {
        const bool is_there = primitive < of_primitive.size() && of_primitive[primitive] != kNone;
        return is_there ? &light[of_primitive[primitive]] : nullptr;
    }
};

/// Of the diffuse and thin-walled primitives that have normal maps. Empty without any map.
TurnedLights make_turned_lights(const PartLights& lights,
                                std::span<const formats::PrimitiveRecord> primitives,
                                std::span<const formats::NormalMapRecord> maps);

/// L'. `radiance`: L, of any sign. Unit normals.
formats::Rgb turn_light(const TurnedLight& light, formats::Rgb radiance, formats::Vec3 from,
                        formats::Vec3 to);

}  // namespace opaline::runtime
