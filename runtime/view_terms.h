#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "formats/opal/asset.h"
#include "formats/opal/rgb.h"
#include "formats/opal/spherical_harmonics.h"
#include "formats/opal/terms.h"
#include "formats/opal/vec3.h"

namespace opaline::runtime {

/// View dependence of a translucent receiver (formats/README.md, "Translucent shading").

/// Unpolarised transmittance 1 - F of a smooth boundary whose far side has `eta` times the index of
/// refraction of the near one, under the cosine `c` on the near side. In [0, 1]. 0 for c <= 0, for
/// NaN and under total internal reflection; c > 1 counts as 1. Precondition: eta > 0.
/// Equals Ft(c'; 1 / eta) with c' the cosine behind the boundary.
float fresnel_transmittance(float c, float eta);

/// The direction to the eye inside the medium: w' = (w - c n) / eta + c' n with
/// c' = sqrt(1 - (1 - c^2) / eta^2), both pointing away from the surface point. For c < 0 (the
/// surface faces away: what surrounds its silhouette is interpolated from there) the limit c -> 0
/// in the same plane; under total internal reflection the limit c' -> 0. Preconditions: unit
/// vectors, c = dot(n, w), eta > 0.
formats::Vec3 refract_to_eye(formats::Vec3 n, formats::Vec3 w, float c, float eta);

/// The normal that a receiver is shaded with, and the direction it is seen from.
struct ViewOfReceiver {
    formats::Vec3 normal;    ///< toward the eye where the primitive is double-sided; unit or zero
    formats::Vec3 to_eye;    ///< unit, or zero where normal is zero and no eye is given
    float cosine = 0;        ///< of the two; below 0 where a single-sided surface faces away
    bool is_turned = false;  ///< whether the normal was turned toward the eye
};

/// `eye` [m, world]; without one, or with one in the receiver itself, it is seen along its normal.
ViewOfReceiver view_receiver(const formats::PrimitiveRecord& primitive, formats::Vec3 position,
                             formats::Vec3 normal, const std::optional<formats::Vec3>& eye);

/// Whether the eye is on the side that the normal points away from. Without an eye: no.
bool is_seen_from_behind(formats::Vec3 position, formats::Vec3 normal,
                         const std::optional<formats::Vec3>& eye);

/// h_k(w_o') for k < value.size(), a number of terms that a file may have: 1 for one term,
/// spherical harmonics otherwise.
void eval_view_terms(formats::Vec3 refracted, std::span<float> value);

/// sum_k h_k(w_o') <T_k, L> of a translucent primitive, from `product` = <T_k, L>, one for each of
/// its terms. `terms`: which of multiple and single scattering; rows that hold both count
/// if both are asked for; rows of single scattering alone, if that is.
formats::Rgb sum_view_terms(const ViewOfReceiver& view, const formats::PrimitiveRecord& primitive,
                            std::span<const formats::Rgb> product,
                            formats::TermSet terms = formats::TermSet::all);

}  // namespace opaline::runtime
