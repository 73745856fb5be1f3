#include <cmath>
#include <numbers>
#include <vector>

#include "bake/physics/dipole.h"
#include "bake/physics/entry.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/path_quadrature.h"
#include "bake/physics/phase.h"
#include "formats/opal/half.h"
#include "formats/opal/sparse_rows.h"
#include "tests/stability/naive_forms.h"
#include "tests/stability/stability_row.h"

// Light that enters bodies, and the dipole.

namespace opaline::tests {
namespace {

using bake::Dipole;
using bake::DipoleKind;
using std::numbers::pi;

// Transmittance times the Jacobian of refraction, each by itself.
float textbook_entry(float c, float eta) {
    const float inside = std::sqrt(1 - (1 - c * c) / (eta * eta));
    const float s = (c - eta * inside) / (c + eta * inside);
    const float p = (eta * c - inside) / (eta * c + inside);
    return (1 - (s * s + p * p) / 2) * c / (eta * eta * inside);
}

// The fluence of the better dipole far away: the difference of two exponentials.
double textbook_better(const Dipole& d, double r) {
    const double dr = std::sqrt(r * r + d.z_real * d.z_real);
    const double dv = std::sqrt(r * r + d.z_virtual * d.z_virtual), k = d.sigma_tr;
    const auto flux = [k](double z, double x) {
        return z * (1 + k * x) * std::exp(-k * x) / (x * x * x);
    };
    return d.w_phi * (std::exp(-k * dr) / dr - std::exp(-k * dv) / dv) +
           d.w_flux * (flux(d.z_real, dr) + flux(d.z_virtual, dv));
}

double textbook_total(const Dipole& d) {
    const double k = d.sigma_tr, a = std::exp(-k * d.z_real), b = std::exp(-k * d.z_virtual);
    return 2 * pi * ((d.w_phi == 0 ? 0 : d.w_phi * (a - b) / k) + d.w_flux * (a + b));
}

// int_0^d sigma_s e^(-sigma_t s) ds by the rule of [Wang2005], as printed.
double textbook_path(double sigma, double sigma_m, double d) {
    const double lambda = 1 - std::exp(-sigma_m * d);
    double sum = 0;
    for (int i = 0; i < 16; ++i) {
        const double s = -std::log(1 - lambda * (i + 0.5) / 16) / sigma_m;
        sum += lambda / 16 / (sigma_m * std::exp(-sigma_m * s)) * sigma * std::exp(-sigma * s);
    }
    return sum;
}

double path_sum(double sigma, double sigma_m, double d) {
    bake::PathMedium medium;
    medium.sigma_s = medium.sigma_t = {sigma, sigma, sigma};
    medium.sigma_m = sigma_m;
    double sum = 0;
    for (const auto& node : bake::place_path_nodes(bake::make_gauss_rule(16), medium, d)) {
        sum += node.weight[0];
    }
    return sum;
}

float textbook_phase(float cosine, float g) {
    const float d = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (4 * std::numbers::pi_v<float> * d * std::sqrt(d));
}

// The detail `value` beside a detail of 1, as the file keeps it.
double stored_detail(float value, std::uint32_t bits) {
    formats::SparseRows rows = formats::make_sparse_rows(8, bits);
    formats::append_row(rows, {1, {1, 2}, {1, value}, {0, 0, 0, 0, 0, 0}});
    std::vector<float> dense(6 * 8 * 8);
    formats::decode_row(rows.view(), {0, 1, 1, 0, 0}, 0, 0, dense);
    return static_cast<double>(dense[2]);
}

}  // namespace

double naive_external(double n) {
    const double n2 = n * n, n4 = n2 * n2;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
           2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
           8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
}

double naive_decay(double sigma_s_prime, double sigma_a) {
    const double sigma_t_prime = sigma_s_prime + sigma_a;
    return std::sqrt(3 * (1 - sigma_s_prime / sigma_t_prime)) * sigma_t_prime;
}

StabilityField surface_rows() {
    const double zero = 0;
    const Dipole no_absorption = bake::make_dipole(DipoleKind::better, 1, 0, 1.3);
    const Dipole hardly = bake::make_dipole(DipoleKind::better, 1, 1e-30, 1.3);
    const Dipole precise = bake::make_dipole(DipoleKind::classic, 1, 1e-15, 1.3);
    Dipole rounded = precise;
    rounded.sigma_tr = naive_decay(1, 1e-15);
    const Dipole marble = bake::make_dipole(DipoleKind::classic, 2.62, 0.0041, 1.5);
    return {
        "Surfaces and the dipole",
        {
            {"η = 1", "1 − F_ext, η = 1", "F_ext in closed form", 1 - naive_external(1),
             1 - bake::fresnel_moments(1).external, "1", 1e-15, 1e-3},
            {"η = 1", "1 − F_ext, η = 1 + 1e-6", "F_ext in closed form",
             1 - naive_external(1 + 1e-6), 1 - bake::fresnel_moments(1 + 1e-6).external,
             "1 - external(double(1 + 1e-6))", 1e-10, 1e-6},
            {"η < 1", "cosine inside; cos .3, η .8", "√(1 − sin²/η²)",
             std::sqrt(1 - (1 - 0.3 * 0.3) / (0.8 * 0.8)), bake::refracted_cosine(0.3, 0.8), "0", 0,
             1},
            {"grazing", "F_t J; cos 0, η 1, floats", "F_t times J",
             static_cast<double>(textbook_entry(0, 1)),
             static_cast<double>(bake::enter<float>(0, {1, true}).throughput), "0", 0, 1},
            {"η > 3.8", "share that leaves a body, 1 − F_dr; η = 3", "fit of F_dr",
             1 - bake::fitted_diffuse_reflectance(3),
             1 - bake::fresnel_moments(3).diffuse_internal(), "1 - 2 * moment(3, 1)", 1e-8, 0.05},
            {"α′ → 1", "σ_tr; σ_s′ 1, σ_a 1e-15", "√(3 (1 − α′)) σ_t′", naive_decay(1, 1e-15),
             bake::make_dipole(DipoleKind::classic, 1, 1e-15, 1.3).sigma_tr,
             "sqrt(3 * mpf(1e-15) * (1 + mpf(1e-15)))", 1e-15, 1e-2},
            {"α′ → 1", "1 − R, classic; σ_s′ 1, σ_a 1e-15, η 1.3", "√(3 (1 − α′)) σ_t′",
             1 - textbook_total(rounded), 1 - bake::dipole_total(precise),
             "1 - tail(classic(1, 1e-15, 1.3), 0)", 1e-8, 1e-2},
            {"σ_a = 0", "total of the better dipole; σ_s′ 1, η 1.3", "(e_r − e_v) / σ_tr",
             textbook_total(no_absorption), bake::dipole_total(no_absorption), "1", 1e-12, 1},
            {"α′ → 1", "the same, σ_a 1e-30", "(e_r − e_v) / σ_tr", textbook_total(hardly),
             bake::dipole_total(hardly), "tail(better(1, 1e-30, 1.3), 0)", 1e-9, 1e-3},
            {"both 0", "total; σ_s′ 0, σ_a 0", "α′ = σ_s′ / σ_t′", zero / (zero + zero),
             bake::dipole_total(bake::make_dipole(DipoleKind::better, 0, 0, 1.3)), "0", 0, 1},
            {"r = 0", "marble, share of a sample of radius 10 / σ_t′", "π a² R_d(0)",
             pi * 16 * bake::eval_dipole(marble, 0), pi * 16 * bake::dipole_disc_mean(marble, 4),
             "tail(classic(2.62, 0.0041, 1.5), 0) - tail(classic(2.62, 0.0041, 1.5), 4)", 1e-8, 1},
            {"better dipole, far away", "R_d(1e6), σ_s′ 1, σ_a 0, η 1.3", "e_r/d_r − e_v/d_v",
             textbook_better(no_absorption, 1e6), bake::eval_dipole(no_absorption, 1e6),
             "profile(better(1, 0, 1.3), 1e6)", 1e-8, 1e-6},
            {"HG g → 1, cos → 1", "g .99, cos 1 − 1e-7", "1 + g² − 2 g cos in floats",
             static_cast<double>(textbook_phase(1 - 1e-7f, 0.99f)),
             bake::henyey_greenstein(1 - 1e-7, 0.99), "henyey(double(1 - 1e-7), 0.99)", 1e-11,
             1e-4},
            {"d_m tiny", "scattered within 1e-18; σ 1", "λ = 1 − e^(−σ d)",
             textbook_path(1, 1, 1e-18), path_sum(1, 1, 1e-18), "1e-18", 1e-14, 1},
            {"d_m tiny", "scattered within 1e-9; σ 1", "λ = 1 − e^(−σ d)",
             textbook_path(1, 1, 1e-9), path_sum(1, 1, 1e-9), "-expm1(-1e-9)", 1e-14, 1e-9},
            {"σ_m = 0", "scattered within 1; σ .5", "−ln(1 − λ ξ) / σ_m", textbook_path(0.5, 0, 1),
             path_sum(0.5, 0, 1), "-expm1(-0.5)", 1e-13, 1},
            {"small numbers in few bits", "a row of 1e-9", "half precision",
             static_cast<double>(formats::float_from_half(formats::half_from_float(1e-9f))),
             1e-9 * stored_detail(1, 8), "1e-9", 1e-2, 1},
            {"one dominant coefficient", "detail .001 beside 1, 8 bits", "127 even steps",
             std::round(0.001 * 127) / 127, stored_detail(0.001f, 8), "0.001", 0.05, 1},
        }};
}

}  // namespace opaline::tests
