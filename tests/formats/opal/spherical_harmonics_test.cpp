#include "formats/opal/spherical_harmonics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace opaline::formats {
namespace {

using Values = std::array<float, kMaxHarmonics>;

Vec3 spherical(double cosine, double azimuth) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return {static_cast<float>(sine * std::cos(azimuth)),
            static_cast<float>(sine * std::sin(azimuth)), static_cast<float>(cosine)};
}

// Signs and order: against associated Legendre functions, whose Condon-Shortley sign is taken off.
TEST(SphericalHarmonics, AreTheTextbookOnesInOrder) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const double cosine = uniform(generator), azimuth = std::numbers::pi * uniform(generator);
        Values y;
        eval_spherical_harmonics(spherical(cosine, azimuth), y);
        for (int l = 0; l <= 4; ++l) {
            for (int m = -l; m <= l; ++m) {
                const auto order = static_cast<unsigned>(std::abs(m));
                const double zonal =
                    (order % 2 == 1 ? -1 : 1) *
                    std::sph_legendre(static_cast<unsigned>(l), order, std::acos(cosine));
                const double expected = m == 0 ? zonal
                                        : m > 0
                                            ? std::numbers::sqrt2 * zonal * std::cos(m * azimuth)
                                            : std::numbers::sqrt2 * zonal * std::sin(-m * azimuth);
                EXPECT_NEAR(y[static_cast<std::size_t>(l * (l + 1) + m)], expected, 3e-6)
                    << "l " << l << ", m " << m;
            }
        }
    }
}

TEST(SphericalHarmonics, FewerOfThemAreTheFirstOnes) {
    const Vec3 w = spherical(0.3, 1.1);
    Values all;
    eval_spherical_harmonics(w, all);
    for (std::uint32_t count = 1; count <= kMaxHarmonics; ++count) {
        if (!is_harmonic_count(count)) continue;
        std::vector<float> some(count);
        eval_spherical_harmonics(w, some);
        EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin())) << count;
    }
}

}  // namespace
}  // namespace opaline::formats
