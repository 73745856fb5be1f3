#include "bake/physics/profile.h"

#include <cmath>
#include <numbers>

#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {
namespace {

template <class... Cases>
struct Overload : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overload(Cases...) -> Overload<Cases...>;

// 1 - kappa: the share of light too close to the beam for diffusion.
double too_close(const BeamDiffusion& profile, const Dipole& source, double r) {
    const double t = source.z_real;
    return std::exp(-2 * profile.sigma_t_prime * (std::hypot(r, t) + t));
}

}  // namespace

double eval_profile(const Profile& profile, double r) {
    return std::visit(
        Overload{[r](const Dipole& p) { return eval_dipole(p, r); },
                 [r](const BeamDiffusion& p) { return eval_beam_diffusion(p, r); },
                 [r](const NormalizedDiffusion& p) { return eval_normalized_diffusion(p, r); }},
        profile);
}

double profile_tail(const Profile& profile, double a) {
    return std::visit(Overload{[a](const Dipole& p) { return dipole_tail(p, a); },
                               [a](const BeamDiffusion& p) { return beam_diffusion_tail(p, a); },
                               [a](const NormalizedDiffusion& p) {
                                   return p.albedo - normalized_diffusion_within(p, a);
                               }},
                      profile);
}

double profile_total(const Profile& profile) {
    return profile_tail(profile, 0);
}

double profile_length(const Profile& profile) {
    return std::visit(
        Overload{[](const Dipole& p) { return p.z_real; },
                 [](const BeamDiffusion& p) { return p.source.empty() ? 0 : 1 / p.sigma_t_prime; },
                 [](const NormalizedDiffusion& p) { return p.albedo > 0 ? p.d : 0; }},
        profile);
}

double profile_width(const Profile& profile) {
    const Dipole* const dipole = std::get_if<Dipole>(&profile);
    return dipole != nullptr ? dipole->z_real : 0;
}

BeamDiffusion make_beam_diffusion(double sigma_s_prime, double sigma_a, double eta) {
    constexpr int kDepths = 128;
    BeamDiffusion profile;
    const Dipole mean = make_dipole(DipoleKind::better, sigma_s_prime, sigma_a, eta);
    if (mean.w_flux == 0 && mean.w_phi == 0) return profile;
    profile.sigma_t_prime = 1 / mean.z_real;
    const double gap = mean.z_virtual - mean.z_real;  // 4 A D, whatever the depth
    for (int i = 0; i < kDepths; ++i) {
        Dipole source = mean;
        source.z_real = -std::log1p(-(i + 0.5) / kDepths) / profile.sigma_t_prime;
        source.z_virtual = source.z_real + gap;
        profile.source.push_back(source);
    }
    return profile;
}

double eval_beam_diffusion(const BeamDiffusion& profile, double r) {
    double sum = 0;
    for (const Dipole& source : profile.source) {
        sum += (1 - too_close(profile, source, r)) * eval_dipole(source, r);
    }
    return profile.source.empty() ? 0 : sum / static_cast<double>(profile.source.size());
}

double beam_diffusion_tail(const BeamDiffusion& profile, double a) {
    static const GaussLegendre rule = make_gauss_legendre(32);
    constexpr double kReach = 8;  // in 1/sigma_t': beyond, kappa is 1 to 1e-7
    constexpr int kPanels = 6;
    double sum = 0;
    for (const Dipole& source : profile.source) {
        sum += dipole_tail(source, a);
        // With r dr = d dd, the integrand peaks at d = t, so panels grow from d(a) on.
        const double from = std::hypot(a, source.z_real), reach = kReach / profile.sigma_t_prime;
        double low = 0;
        for (int panel = 0; panel < kPanels; ++panel) {
            const double high = std::pow(4.0, panel - kPanels + 1) * reach;
            for (std::size_t i = 0; i < rule.node.size(); ++i) {
                const double d = from + low + (high - low) * rule.node[i];
                const double r = std::sqrt(std::max(0.0, d * d - source.z_real * source.z_real));
                sum -= 2 * std::numbers::pi * d * (high - low) * rule.weight[i] *
                       too_close(profile, source, r) * eval_dipole(source, r);
            }
            low = high;
        }
    }
    return profile.source.empty() ? 0 : sum / static_cast<double>(profile.source.size());
}

double normalized_diffusion_shape(double albedo, DiffusionLength kind) {
    const double x = albedo - 0.8;
    switch (kind) {
        case DiffusionLength::mean_free_path_searchlight:
            return 1.85 - albedo + 7 * std::abs(x * x * x);
        case DiffusionLength::mean_free_path_diffuse:
            return 1.9 - albedo + 3.5 * x * x;
        default:
            return 3.5 + 100 * std::pow(albedo - 0.33, 4);
    }
}

NormalizedDiffusion make_normalized_diffusion(double albedo, double length, DiffusionLength kind) {
    return {albedo, length / normalized_diffusion_shape(albedo, kind)};
}

double eval_normalized_diffusion(const NormalizedDiffusion& profile, double r) {
    const double x = r / profile.d;
    return profile.albedo * (std::exp(-x) + std::exp(-x / 3)) /
           (8 * std::numbers::pi * profile.d * r);
}

double normalized_diffusion_within(const NormalizedDiffusion& profile, double a) {
    // 1 - e^-x / 4 - 3 e^(-x/3) / 4, without cancellation for small a.
    const double x = a / profile.d;
    return -profile.albedo * (0.25 * std::expm1(-x) + 0.75 * std::expm1(-x / 3));
}

}  // namespace opaline::bake
