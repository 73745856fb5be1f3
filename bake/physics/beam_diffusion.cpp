#include "bake/physics/profile.h"

#include <cmath>
#include <numbers>

#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {
namespace {

// 1 - kappa: the share of light too close to the beam for diffusion.
double too_close(const BeamDiffusion& profile, const Dipole& source, double r) {
    const double t = source.z_real;
    return std::exp(-2 * profile.sigma_t_prime * (std::hypot(r, t) + t));
}

}  // namespace

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

}  // namespace opaline::bake
