#pragma once

namespace opaline::bake {

/// Unpolarised Fresnel reflectance of a smooth boundary (README.md, "Fresnel"). `cosine`: between
/// direction and normal on the incident side, in [0, 1]. `eta`: index of the far side over index of
/// the incident side, > 0. Returns 1 beyond the critical angle and at grazing incidence.
double fresnel_reflectance(double cosine, double eta);
/// 1 - fresnel_reflectance, without its cancellation near eta = 1.
double fresnel_transmittance(double cosine, double eta);

/// Cosine on the far side, sqrt(1 - (1 - cosine^2) / eta^2); 0 beyond the critical angle.
double refracted_cosine(double cosine, double eta);

/// Cosine-weighted moments of the reflectance of a boundary with index `eta` > 0.
struct FresnelMoments {
    double c1 = 0;        ///< int_0^1 F(mu; 1 / eta) mu dmu, seen from inside
    double c2 = 0;        ///< int_0^1 F(mu; 1 / eta) mu^2 dmu
    double external = 0;  ///< F_ext = 2 int_0^1 F(mu; eta) mu dmu, seen from outside

    double diffuse_internal() const { return 2 * c1; }  ///< F_dr
};

/// By quadrature, to about 1e-10 (README.md, "Fresnel").
FresnelMoments fresnel_moments(double eta);

/// F_dr by the rational fit that [Wang2005] uses: good to 2e-3 for eta in [1/2, 2], wrong outside.
double fitted_diffuse_reflectance(double eta);

}  // namespace opaline::bake
