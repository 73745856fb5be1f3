#pragma once

#include <vector>

#include "bake/scattering/dipole.h"

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

}  // namespace opaline::bake
