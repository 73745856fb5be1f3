#pragma once

#include <complex>

#include "bake/physics/mie/sphere_scattering.h"

namespace opaline::tests {

// Forms of textbooks in double precision that the table and the picture share.

/// The efficiencies of a sphere: Riccati-Bessel functions of x and m x upward from the sine,
/// products of these, absorption as a difference.
bake::MieEfficiencies naive_mie(double x, std::complex<double> m);

/// F_ext of an index n > 1 in closed form.
double naive_external(double n);

/// sigma_tr = sqrt(3 (1 - albedo)) sigma_t'.
double naive_decay(double sigma_s_prime, double sigma_a);

/// e^-absorption (e^ell - 1) / e^ell.
double naive_share(double absorption, double ell);

/// (1 - c^2) / q.
double naive_square_sine(double cosine, double q);

/// (1 + g^2 - f^2) / (2 g): the cosine within which Henyey and Greenstein's function has the share
/// q.
double naive_peak_cosine(double g, double q);

}  // namespace opaline::tests
