#pragma once

#include <variant>

#include "bake/scattering/beam_diffusion.h"
#include "bake/scattering/dipole.h"
#include "bake/scattering/normalized_diffusion.h"

namespace opaline::bake {

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
