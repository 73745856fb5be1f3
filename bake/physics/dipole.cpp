#include "bake/physics/dipole.h"

#include <cmath>
#include <numbers>

#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

// d_v - d_r at distance r, without the cancellation of two long distances.
double distance_gap(const Dipole& dipole, double d_real, double d_virtual) {
    return (dipole.z_virtual - dipole.z_real) * (dipole.z_virtual + dipole.z_real) /
           (d_virtual + d_real);
}

// (e^(-k a) - e^(-k b)) / k for b = a + gap, also at k = 0, where it is the gap.
double exponential_difference(double k, double a, double gap) {
    const double x = k * gap;
    return x == 0 ? gap : std::exp(-k * a) * gap * (-std::expm1(-x) / x);
}

}  // namespace

Dipole make_dipole(DipoleKind kind, double sigma_s_prime, double sigma_a, double eta) {
    const double sigma_t_prime = sigma_s_prime + sigma_a;
    if (!(sigma_s_prime > 0)) {
        return {};
    }
    const double albedo = sigma_s_prime / sigma_t_prime;
    const FresnelMoments moments = fresnel_moments(eta);
    Dipole dipole;
    dipole.z_real = 1 / sigma_t_prime;
    if (kind == DipoleKind::better) {
        const double diffusion =
            (2 * sigma_a + sigma_s_prime) / (3 * sigma_t_prime * sigma_t_prime);
        const double a = (1 + 3 * moments.c2) / (1 - 2 * moments.c1);
        dipole.sigma_tr = std::sqrt(sigma_a / diffusion);
        dipole.z_virtual = dipole.z_real + 4 * a * diffusion;
        // alpha'^2, because the single-scattering stage adds the light that scatters once.
        const double strength = albedo * albedo / (4 * pi);
        dipole.w_phi = strength * 0.25 * (1 - 2 * moments.c1) / diffusion;
        dipole.w_flux = strength * 0.5 * (1 - 3 * moments.c2);
        return dipole;
    }
    const double f_dr =
        kind == DipoleKind::classic ? moments.diffuse_internal() : fitted_diffuse_reflectance(eta);
    const double a = (1 + f_dr) / (1 - f_dr);
    dipole.sigma_tr = std::sqrt(3 * sigma_a * sigma_t_prime);
    dipole.z_virtual = dipole.z_real * (1 + 4 * a / 3);
    dipole.w_flux = albedo / (4 * pi);
    return dipole;
}

double eval_dipole(const Dipole& dipole, double r) {
    if (dipole.w_flux == 0 && dipole.w_phi == 0) return 0;
    const double d_real = std::hypot(r, dipole.z_real);
    const double d_virtual = std::hypot(r, dipole.z_virtual);
    const double k = dipole.sigma_tr;
    const auto flux = [k](double z, double d) {
        return z * (1 + k * d) * std::exp(-k * d) / (d * d * d);
    };
    double value =
        dipole.w_flux * (flux(dipole.z_real, d_real) + flux(dipole.z_virtual, d_virtual));
    if (dipole.w_phi != 0) {
        // e_r/d_r - e_v/d_v = (e_r/d_r) (gap/d_v - (d_r/d_v) expm1(-k gap)): no cancellation far
        // away.
        const double gap = distance_gap(dipole, d_real, d_virtual);
        value += dipole.w_phi * std::exp(-k * d_real) / d_real *
                 (gap / d_virtual - d_real / d_virtual * std::expm1(-k * gap));
    }
    return value;
}

double dipole_tail(const Dipole& dipole, double a) {
    if (dipole.w_flux == 0 && dipole.w_phi == 0) return 0;
    const double d_real = std::hypot(a, dipole.z_real);
    const double d_virtual = std::hypot(a, dipole.z_virtual);
    const double k = dipole.sigma_tr;
    // r dr = d dd: each term integrates in closed form.
    const double flux = dipole.z_real * std::exp(-k * d_real) / d_real +
                        dipole.z_virtual * std::exp(-k * d_virtual) / d_virtual;
    const double fluence =
        exponential_difference(k, d_real, distance_gap(dipole, d_real, d_virtual));
    return 2 * pi * (dipole.w_flux * flux + dipole.w_phi * fluence);
}

double dipole_total(const Dipole& dipole) {
    return dipole_tail(dipole, 0);
}

double dipole_disc_mean(const Dipole& dipole, double a) {
    return (dipole_total(dipole) - dipole_tail(dipole, a)) / (pi * a * a);
}

double dipole_fourier(const Dipole& dipole, double k) {
    const double kappa = std::hypot(dipole.sigma_tr, k);
    const double flux = std::exp(-dipole.z_real * kappa) + std::exp(-dipole.z_virtual * kappa);
    const double fluence =
        exponential_difference(kappa, dipole.z_real, dipole.z_virtual - dipole.z_real);
    return 2 * pi * (dipole.w_flux * flux + dipole.w_phi * fluence);
}

}  // namespace opaline::bake
