#pragma once

#include <variant>
#include <vector>

#include "bake/physics/dipole.h"

namespace opaline::bake {

/// Photon beam diffusion [Habel2013], multiple part: the better dipole averaged over the depth at
/// which a beam entering at a right angle first scatters (README.md, "Photon beam diffusion"),
///   R_d(r) = mean over t of kappa(r, t) R_d^t(r), kappa = 1 - exp(-2 sigma_t' (d_r + t)).
struct BeamDiffusion {
    std::vector<Dipole> source;  ///< one per depth t, with equal weights; empty: black
    double sigma_t_prime = 0;
};

/// Arguments as for make_dipole.
BeamDiffusion make_beam_diffusion(double sigma_s_prime, double sigma_a, double eta);

/// R_d(r) [1/length^2], r >= 0.
double eval_beam_diffusion(const BeamDiffusion& profile, double r);
/// int_a^inf R_d 2 pi r dr, to 1e-6 of the total: by quadrature where kappa differs from 1, in
/// closed form elsewhere.
double beam_diffusion_tail(const BeamDiffusion& profile, double a);

/// Normalised diffusion [Christensen2015]: a fit to the whole response of a
/// half space, single scattering included. Total reflectance is `albedo` exactly.
struct NormalizedDiffusion {
    double albedo = 0;  ///< of the surface, in [0, 1]
    double d = 1;       ///< length / s, > 0
};

/// Which length and light the fitted shape s(albedo) is for.
enum class DiffusionLength {
    mean_free_path_searchlight,  ///< collimated light at normal incidence
    mean_free_path_diffuse,      ///< diffuse light
    diffuse_mean_free_path       ///< 1 / sigma_tr
};

/// Shape factor s(albedo).
double normalized_diffusion_shape(double albedo, DiffusionLength kind);
NormalizedDiffusion make_normalized_diffusion(double albedo, double length, DiffusionLength kind);

/// R_d(r) [1/length^2], r > 0; grows without bound as r falls to 0.
double eval_normalized_diffusion(const NormalizedDiffusion& profile, double r);
/// int_0^a R_d 2 pi r dr.
double normalized_diffusion_within(const NormalizedDiffusion& profile, double a);

/// Any diffuse reflectance profile R_d(r) of a half space.
using Profile = std::variant<Dipole, BeamDiffusion, NormalizedDiffusion>;

/// R_d(r) [1/length^2]; r > 0 where the profile has no finite centre.
double eval_profile(const Profile& profile, double r);
/// int_a^inf R_d 2 pi r dr, a >= 0.
double profile_tail(const Profile& profile, double a);
double profile_total(const Profile& profile);
/// Characteristic length: the reduced mean free path, or d of normalised diffusion. 0: black.
double profile_length(const Profile& profile);
/// Sample spacing at which the plain sum errs by about 1 %: the depth of a dipole's source
/// (multiple/README.md, "Sampling"). 0: the profile is too steep at its centre for any spacing.
double profile_width(const Profile& profile);

}  // namespace opaline::bake
