#include "bake/lights/daylight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::bake {
namespace {

double perez(const std::array<double, 5>& k, double cos_theta, double gamma) {
    // At the horizon B / cos theta tends to minus infinity, as B < 0 for every turbidity here.
    const double height = std::max(cos_theta, 1e-3);
    const double cos_gamma = std::cos(gamma);
    return (1 + k[0] * std::exp(k[1] / height)) *
           (1 + k[2] * std::exp(k[3] * gamma) + k[4] * cos_gamma * cos_gamma);
}

/// Zenith chromaticity: cubic in the sun's angle, quadratic in turbidity.
double zenith_chromaticity(const std::array<std::array<double, 4>, 3>& m, double turbidity,
                           double theta) {
    const auto cubic = [&](const std::array<double, 4>& c) {
        return ((c[0] * theta + c[1]) * theta + c[2]) * theta + c[3];
    };
    return (cubic(m[0]) * turbidity + cubic(m[1])) * turbidity + cubic(m[2]);
}

/// Transmittance of `mass` atmospheres.
double transmittance(double nm, double turbidity, double mass) {
    const double um = 1e-3 * nm;
    const double molecules = 0.008735 * std::pow(um, -4.08);
    const double aerosol = std::max(0.0, 0.04608 * turbidity - 0.04586) * std::pow(um, -1.3);
    // The Chappuis band [1/cm], a Gaussian through its peak and half width.
    const double ozone = 0.35 * 0.125 * formats::spectral_lobe(nm, 600.0, 47.0, 47.0);
    return std::exp(-mass * (molecules + aerosol + ozone));
}

}  // namespace

PerezSky make_perez_sky(double turbidity, double sun_zenith) {
    const double t = turbidity;
    PerezSky sky;
    sky.coefficient = {{{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251,
                         0.1206 * t - 2.5771, -0.0670 * t + 0.3703},
                        {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125,
                         -0.0641 * t - 0.8989, -0.0033 * t + 0.0452},
                        {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102,
                         -0.0441 * t - 1.6537, -0.0109 * t + 0.0529}}};
    const double chi = (4.0 / 9.0 - t / 120.0) * (std::numbers::pi - 2 * sun_zenith);
    sky.zenith = {(4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192,
                  zenith_chromaticity({{{0.00166, -0.00375, 0.00209, 0},
                                        {-0.02903, 0.06377, -0.03202, 0.00394},
                                        {0.11693, -0.21196, 0.06052, 0.25886}}},
                                      t, sun_zenith),
                  zenith_chromaticity({{{0.00275, -0.00610, 0.00317, 0},
                                        {-0.04214, 0.08970, -0.04153, 0.00516},
                                        {0.15346, -0.26756, 0.06670, 0.26688}}},
                                      t, sun_zenith)};
    for (std::size_t i = 0; i < 3; ++i) {
        sky.zenith_distribution[i] = perez(sky.coefficient[i], 1.0, sun_zenith);
    }
    return sky;
}

Xyz eval_perez_sky(const PerezSky& sky, double cos_theta, double gamma) {
    std::array<double, 3> value{};
    for (std::size_t i = 0; i < 3; ++i) {
        value[i] = sky.zenith[i] * perez(sky.coefficient[i], cos_theta, gamma) /
                   sky.zenith_distribution[i];
    }
    const auto [luminance, x, y] = value;
    return {luminance * x / y, luminance, luminance * (1 - x - y) / y};
}

Xyz sun_irradiance(double turbidity, double sun_zenith) {
    const double degrees = sun_zenith * 180 / std::numbers::pi;
    const double mass = 1.0 / (std::cos(sun_zenith) + 0.15 * std::pow(93.885 - degrees, -1.253));
    Xyz sum{};
    double outside = 0;
    for (double nm = 360; nm <= 830; nm += 5) {
        const double power = formats::planck(nm, 5778);
        const Xyz response = formats::color_matching(nm);
        outside += power * response[1];
        for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += power * response[i] * transmittance(nm, turbidity, mass);
        }
    }
    constexpr double kOutsideKlx = 128;
    return {kOutsideKlx * sum[0] / outside, kOutsideKlx * sum[1] / outside,
            kOutsideKlx * sum[2] / outside};
}

}  // namespace opaline::bake
