#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "bake/plan/effect.h"
#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Share of even light that reaches a depth [m] in a medium, or at least as much: a bound for each
/// band, of which the largest is taken. The smaller of e^(-sigma_a depth), as no way there is
/// shorter, and of
///     (1 + kappa/sigma_t') / alpha' (kappa depth) / sinh(kappa depth) / (1 - F_dr),
/// with 1 / kappa the diffusion length of the similar isotropic medium by transport theory
/// [CaseZweifel1967]: e^(kappa n . x) psi(n . w), psi the eigenfunction, summed over all n, is what
/// walks keep on average, and at a distance it is at least that much larger than at the start. The
/// last factor counts walks that the boundary sends back in. 1 where nothing is absorbed.
double share_that_reaches(const formats::Medium& medium, double depth);

/// Bound on how much other media inside a body change its light under `white`: the share of light
/// that reaches the nearest one that differs from the body's own. 0: there is none.
double layer_bound(const formats::Medium& medium, const MaterialFacts& body);

/// The rule `multiple.layers`: whether walks must pass through the media inside. After the rule
/// `multiple`.
bool has_inner_media(const PlanInput& input);
PlanEntry decide_layers(const PlanInput& input);

/// The entry of that name among those decided on before; null: there is none.
const PlanEntry* earlier_entry(const PlanInput& input, std::string_view name);

/// The materials of the media inside. Walks need them whether the rule is on or off.
std::vector<std::uint32_t> inner_materials(const EffectInputs& inputs);

/// Whether the body touches or overlaps some of these.
bool meets_others(const EffectInputs& inputs);

/// Warns where the model in use ignores them.
void warn_of_layers(const EffectInputs& inputs, std::vector<formats::Diagnostic>& warnings);

/// Light that scatters several times in a medium. The bound is the smaller of twice the reflectance
/// of a half space by diffusion, and small_body_bound (README.md, "Bounds"). The first bounds the
/// model: the light that truly crosses a thin body with a forward phase function may be more.
PlanEntry decide_multiple(const PlanInput& input);

/// Bound on the radiance of a body in one band after two or more scattering events, under radiance
/// of at most 1; also a bound on the result of diffusion. `diagonal` [m] of the body's bounding
/// box, `area` [m^2] of its surface. Infinity if eta is not 1: with internal reflection, light may
/// travel any distance in a small body.
///
/// A line of length d through the body gains by scattering at most the share alpha (1 - e^(-sigma_t
/// d)) of the light at its points. The part of that light that scattered before is at most such a
/// share again. Diffusion sums R_d over the surface, so it is at most R_d(0) A, because R_d is
/// largest at its centre. Where R_d is scaled to a walk's energy, the walk returns at most alpha^2.
double small_body_bound(const formats::Medium& medium, const Band& band, double diagonal,
                        double area);

/// One rule: whether light spreads along the surface of a medium, or leaves where it entered
/// (README.md, "Bounds"). The bound is the sum of three errors of a half space lit like the vertex:
/// irradiance that varies over four mean edges and is blurred by the profile, light that passes
/// through the body, and facets tilted against the smooth surface.
std::span<const DecisionRule> spread_rules();

}  // namespace opaline::bake
