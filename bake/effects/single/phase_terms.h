#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/physics/entry.h"

namespace opaline::bake {

/// A phase function by its Legendre coefficients (physics/README.md, "Phase functions"):
///     p(cos Theta) = sum_l lambda_l (2 l + 1) / (4 pi) P_l(cos Theta),   lambda_0 = 1,
/// lambda_l = g^l for Henyey-Greenstein. Every degree gives 2 l + 1 terms g_lm(w_i') h_lm(w_o'),
/// g_lm = lambda_l Y_lm(-w_i') and h_lm = Y_lm(w_o') with the Y of eval_spherical_harmonics, and
/// K = (L + 1)^2 terms in all. A single term is g = 1/(4 pi), h = 1 instead.
struct PhaseTerms {
    std::vector<float> lambda{1.0f};  ///< degrees 0 ... L, L <= 4

    std::uint32_t count() const {
        return static_cast<std::uint32_t>(lambda.size() * lambda.size());
    }
};

/// Upper bound of |g_k| for each term [1/sr].
std::vector<float> largest_phase_terms(const PhaseTerms& phase);

/// g_k(w_i') for light from `w` that enters through a boundary of the given outward normal (both
/// unit, n . w > 0); `value`: phase.count() terms.
void eval_phase_terms(const PhaseTerms& phase, float eta, glm::vec3 w, glm::vec3 normal,
                      const Entry<float>& entry, float cosine, std::span<float> value);

}  // namespace opaline::bake
