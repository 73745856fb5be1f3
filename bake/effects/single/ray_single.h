#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/physics/entry.h"
#include "bake/physics/path_quadrature.h"
#include "bake/trace/body.h"
#include "bake/trace/direction_set.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

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

/// The properties of a material that single scattering needs, derived once.
struct SingleMedium {
    std::uint32_t material = 0;  ///< index into Scene::materials
    PathMedium path;
    PathRule rule;
    Interface<float> boundary;
    PhaseTerms phase;
    float path_limit = 0;     ///< [m], where a path without an exit ends
    std::uint32_t bands = 3;  ///< to gather; 1: the first stands for all
};

/// `material` must have a medium. `depth_samples`: nodes along the inward normal; Gauss-Legendre,
/// or midpoints in a medium of fidelity `paper`. With 8, a relit value errs by 0.2 to 0.5 %.
/// `phase`: terms to use instead of the scene's phase function. `bands`: 3, or 1 where the three
/// bands of the medium coincide.
SingleMedium make_single_medium(const formats::Scene& scene, std::uint32_t material,
                                std::uint32_t depth_samples, PhaseTerms phase = {},
                                std::uint32_t bands = 3);

/// An interior point below a body point, at which incoming light is evaluated.
struct InteriorNode {
    glm::vec3 position;       ///< [m]
    float weight[3];          ///< of T_p, per channel
    std::int32_t shells = 1;  ///< of the medium around it
};

/// The nodes of the path from `point`; none if the path leaves the body at once. Nodes outside the
/// medium, as inconsistent meshes can have, are left out.
std::vector<InteriorNode> place_interior_nodes(const SingleMedium& medium, const BodyPoint& point,
                                               const InwardPath& path);

/// The share of its texel's solid angle that each direction stands for, block by block.
std::vector<RayPacket::Lane> texel_shares(const DirectionSet& directions);

/// Single scattering transport of one receiver by rays ([Wang2005] eqs. (10)
/// and (11) with the Jacobian of refraction; README.md, "Transport"):
///     T_k(w) = int_0^d_m sigma_s g_k(w_i') Ft J e^{-sigma_t s_i'} V e^{-sigma_t s} ds,
/// so that L1 = Ft(w_o) sum_k h_k(w_o') <T_k, L>; g_k, h_k: see PhaseTerms. `transport`: mean over
/// each texel, term by term band by band, K * bands * 6 n n values, unit 1/sr; the light carries
/// the solid angle. `shares`: of `directions`. `point` must be of the medium's material.
EntryCounts gather_single(const RayScene& rays, const DirectionSet& directions,
                          std::span<const RayPacket::Lane> shares, const SingleMedium& medium,
                          const BodyPoint& point, std::span<float> transport);

}  // namespace opaline::bake
