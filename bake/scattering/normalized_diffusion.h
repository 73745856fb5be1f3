#pragma once

namespace opaline::bake {

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

}  // namespace opaline::bake
