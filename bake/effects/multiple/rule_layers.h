#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "bake/plan/effect.h"

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

/// Warns where the model in use ignores them.
void warn_of_layers(const EffectInputs& inputs, std::vector<formats::Diagnostic>& warnings);

}  // namespace opaline::bake
