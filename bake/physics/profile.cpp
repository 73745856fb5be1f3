#include "bake/physics/profile.h"

namespace opaline::bake {
namespace {

template <class... Cases>
struct Overload : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overload(Cases...) -> Overload<Cases...>;

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

}  // namespace opaline::bake
