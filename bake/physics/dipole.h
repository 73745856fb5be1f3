#pragma once

namespace opaline::bake {

/// Diffuse reflectance profile R_d(r) of a half space lit at a point, by a real source below the
/// surface and a virtual one above it ([Jensen2001], [Deon2012]; README.md, "Dipole"),
///   R_d = w_phi (e_r / d_r - e_v / d_v) + w_E sum over z of z (1 + sigma_tr d) e / d^3,
///   d = sqrt(r^2 + z^2), e = e^(-sigma_tr d), z in {z_real, z_virtual}.
/// Lengths are in the inverse unit of the coefficients.
struct Dipole {
    double z_real = 0, z_virtual = 0;  ///< depth and height of the sources, > 0
    double sigma_tr = 0;               ///< effective extinction, >= 0
    double w_phi = 0, w_flux = 0;      ///< weights of fluence and of its gradient; both 0: black
};

enum class DipoleKind {
    classic,         ///< [Jensen2001], exact Fresnel moments
    classic_fitted,  ///< with the fit of F_dr, as [Wang2005] prints it
    better           ///< [Deon2012]: Grosjean's diffusion constant, both moments in the boundary
};

/// `sigma_s_prime`: reduced scattering (1 - g) sigma_s, `sigma_a`: absorption, both >= 0 and
/// finite; `eta` in [1/3, 3]. A medium without scattering gives 0 everywhere.
Dipole make_dipole(DipoleKind kind, double sigma_s_prime, double sigma_a, double eta);

/// R_d(r) [1/length^2], r >= 0: finite, >= 0, decreasing.
double eval_dipole(const Dipole& dipole, double r);
/// R = int_0^inf R_d 2 pi r dr, in [0, 1].
double dipole_total(const Dipole& dipole);
/// int_a^inf R_d 2 pi r dr.
double dipole_tail(const Dipole& dipole, double a);
/// Mean of R_d over the disc of radius a > 0: (R - tail(a)) / (pi a^2).
double dipole_disc_mean(const Dipole& dipole, double a);
/// Two-dimensional Fourier transform of R_d at wave number k: the attenuation of a
/// sinusoidal irradiance.
double dipole_fourier(const Dipole& dipole, double k);

}  // namespace opaline::bake
