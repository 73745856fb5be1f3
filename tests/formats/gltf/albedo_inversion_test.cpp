#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "formats/gltf/map_medium.h"

namespace opaline::tests {
namespace {

using formats::gltf::single_scattering_albedo;

constexpr double kThreeErrors = 0.0105;  ///< of half_space_reflectance

enum class Incidence { diffuse, normal };

/// Share of light, diffuse or of normal incidence, that an index-matched half space sends back: a
/// random walk of 20000 paths, whose standard error is below 0.0036 as no path sends back more
/// than 1.
double half_space_reflectance(double albedo, double g, Incidence light) {
    constexpr int kPaths = 20000;
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    double reflected = 0;
    for (int path = 0; path < kPaths; ++path) {
        double depth = 0, weight = 1;
        double mu = light == Incidence::diffuse ? std::sqrt(uniform(generator)) : 1;
        for (;;) {
            depth -= mu * std::log1p(-uniform(generator));
            if (depth < 0) {
                reflected += weight;
                break;
            }
            weight *= albedo;
            if (weight < 0.05) {
                if (uniform(generator) > 0.1) break;
                weight *= 10;
            }
            const double u = uniform(generator);
            const double q = (1 - g * g) / (1 - g + 2 * g * u);
            const double c = g == 0 ? 2 * u - 1 : (1 + g * g - q * q) / (2 * g);
            mu = mu * c + std::sqrt(std::max(0.0, (1 - mu * mu) * (1 - c * c))) *
                              std::cos(6.283185307179586 * uniform(generator));
        }
    }
    return reflected / kPaths;
}

TEST(AlbedoInversion, ReturnsTheColourOfTheForwardFit) {
    // The forward fit of van de Hulst that Kulla and Conty invert:
    // colour = (1 - s)(1 - 0.139 s)/(1 + 1.17 s), s^2 = (1 - albedo)/(1 - g albedo).
    for (const double g : {-0.9, 0.0, 0.5, 0.99}) {
        for (const double color : {0.001, 0.1, 0.5, 0.8, 0.99, 1.0}) {
            const double albedo = single_scattering_albedo(color, g);
            EXPECT_GE(albedo, 0);
            EXPECT_LE(albedo, 1);
            const double s = std::sqrt((1 - albedo) / (1 - g * albedo));
            // The published constants have six digits.
            EXPECT_NEAR((1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s), color, 2e-5)
                << color << " " << g;
        }
        EXPECT_EQ(single_scattering_albedo(0, g), 0);
        EXPECT_EQ(single_scattering_albedo(1, g), 1);
    }
}

TEST(AlbedoInversion, ThickMediumReflectsItsColourOfDiffuseLightWhateverTheAnisotropy) {
    for (const double g : {0.0, 0.5, 0.8}) {
        EXPECT_NEAR(half_space_reflectance(single_scattering_albedo(0.8, g), g, Incidence::diffuse),
                    0.8, kThreeErrors)
            << g;
    }
}

TEST(AlbedoInversion, LeavingOutTheAnisotropyDarkensAForwardScatteringMedium) {
    // At normal incidence 0.759 at g = 0, and 0.531 where the albedo of g = 0 meets g = 0.8.
    EXPECT_NEAR(half_space_reflectance(single_scattering_albedo(0.8, 0), 0, Incidence::normal),
                0.759, kThreeErrors);
    EXPECT_NEAR(half_space_reflectance(single_scattering_albedo(0.8, 0), 0.8, Incidence::normal),
                0.531, kThreeErrors);
    // Similarity holds for diffuse light; at one angle it is a little off, at most 0.01 here.
    EXPECT_NEAR(half_space_reflectance(single_scattering_albedo(0.8, 0.8), 0.8, Incidence::normal),
                0.759, 0.01 + kThreeErrors);
}

}  // namespace
}  // namespace opaline::tests
