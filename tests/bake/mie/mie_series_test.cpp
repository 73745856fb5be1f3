#include "bake/physics/mie/mie_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "bake/physics/mie/sphere_scattering.h"

namespace opaline::bake {
namespace {

using Complex = std::complex<double>;

using std::numbers::pi;

double relative(double a, double b) {
    return std::abs(a - b) / std::abs(b);
}

// The dipole alone: a_1 = -i (2/3) x^3 (m^2 - 1) / (m^2 + 2), of which the next term is smaller by
// x^2.
TEST(MieSeries, TinySpheresScatterAsRayleighSays) {
    for (const Complex m : {Complex(1.33, 0), Complex(1.5, 1), Complex(10, 10), Complex(0.2, 0)}) {
        const Complex k = (m * m - 1.0) / (m * m + 2.0);
        for (const double x : {1e-12, 1e-9, 1e-6, 1e-4}) {
            const MieEfficiencies q = sphere_efficiencies(x, m);
            const double scattering = 8.0 / 3 * std::pow(x, 4) * std::norm(k);
            const double bound = 1e-10 + 1e3 * x * x;
            EXPECT_LT(relative(q.q_sca, scattering), bound) << x << m;
            EXPECT_LT(relative(q.q_back, 4 * std::pow(x, 4) * std::norm(k)), bound) << x << m;
            if (m.imag() > 0) {
                EXPECT_LT(relative(q.q_abs, 4 * x * k.imag()), bound) << x << m;
            } else {
                EXPECT_EQ(q.q_abs, 0);
            }
            EXPECT_LT(std::abs(q.g), 1e-3 + x);
        }
    }
}

// Digits that the form with logarithmic derivatives loses below x = 0.1: the mean cosine comes from
// a_1 b_1* and a_1 a_2*, and is proportional to x^2.
TEST(MieSeries, MeanCosineOfSmallSpheresKeepsItsDigits) {
    for (const Complex m : {Complex(1.33, 0), Complex(1.5, 0.5)}) {
        const double limit = sphere_efficiencies(1e-4, m).g / 1e-8;
        for (const double x : {1e-9, 1e-7, 1e-5}) {
            EXPECT_LT(relative(sphere_efficiencies(x, m).g / (x * x), limit), 1e-7) << x;
        }
    }
    EXPECT_NEAR(sphere_efficiencies(0.01, 1.33).q_sca, 1.109880e-9, 1e-15);
}

TEST(MieSeries, SphereOfPositiveMultiplesOfPiIsNothingSpecial) {
    EXPECT_NEAR(sphere_efficiencies(pi, 1.333).q_ext, 1.957724, 1e-6);
    for (int n = 1; n < 400; n += 7) {
        const double x = n * pi;
        const double beside = (sphere_efficiencies(x * (1 - 1e-9), 1.2).q_sca +
                               sphere_efficiencies(x * (1 + 1e-9), 1.2).q_sca) /
                              2;
        EXPECT_LT(relative(sphere_efficiencies(x, 1.2).q_sca, beside), 1e-8) << n;
    }
}

// psi_1(z) = 0 where tan z = z: the ratio psi_2 / psi_1 inside the sphere is infinite.
TEST(MieSeries, ZeroOfTheFieldInsideIsNothingSpecial) {
    const double z = 4.493409457909064;
    for (const double m : {0.75, 1.5, 3.0}) {
        const double x = z / m;
        const double beside = (sphere_efficiencies(x * (1 - 1e-7), m).q_sca +
                               sphere_efficiencies(x * (1 + 1e-7), m).q_sca) /
                              2;
        EXPECT_LT(relative(sphere_efficiencies(x, m).q_sca, beside), 1e-6) << m;
    }
}

TEST(MieSeries, AbsorptionInsideNeverOverflows) {
    // e^(Im(m x)) is 1e43429 here.
    const MieEfficiencies more = sphere_efficiencies(1e5, {1.5, 1});
    EXPECT_NEAR(more.q_ext, 2, 2e-3);
    EXPECT_NEAR(more.q_sca, 1.2366, 5e-3);  // geometric optics: nothing comes out again
}

// A perfect conductor has a_n = psi_n' / xi_n' and b_n = psi_n / xi_n; the field enters a skin of
// relative depth 1 / (|m| x).
TEST(MieSeries, HugeIndexIsAPerfectConductor) {
    const double x = 1.5;
    MieSeries series;
    expand_sphere(x, {1000, 1000}, series);
    for (std::size_t n = 1; n <= 4; ++n) {
        const double order = static_cast<double>(n + 1) / x;
        const Complex xi(series.psi[n], -series.chi[n]),
            next(series.psi[n + 1], -series.chi[n + 1]);
        const Complex a = (order * series.psi[n] - series.psi[n + 1]) / (order * xi - next);
        const Complex b = series.psi[n] / xi;
        EXPECT_LT(std::abs(series.a[n - 1] - a), 2e-3 * std::abs(a)) << n;
        EXPECT_LT(std::abs(series.b[n - 1] - b), 2e-3 * static_cast<double>(n + 1) * std::abs(b))
            << n;
    }
}

// Born's approximation: the amplitude is proportional to m - 1.
TEST(MieSeries, IndexNearOneScattersAsTheSquareOfItsDifference) {
    const double ratio = sphere_efficiencies(2, 1 + 1e-4).q_sca / 1e-8;
    for (const double difference : {1e-5, 1e-7, 1e-9}) {
        EXPECT_LT(relative(sphere_efficiencies(2, 1 + difference).q_sca / (difference * difference),
                           ratio),
                  1e-3)
            << difference;
    }
    const MieEfficiencies none = sphere_efficiencies(2, 1);
    EXPECT_EQ(none.q_ext, 0);
    EXPECT_EQ(none.g, 0);
}

TEST(MieSeries, EverySphereHasFiniteSoundEfficiencies) {
    MieSeries series;
    for (double x = kMinSizeParameter; x <= kMaxSizeParameter; x *= 31.7) {
        for (const double real : {1e-3, 0.5, 1 - 1e-15, 1.0, 1.333, 30.0, 1e3}) {
            for (const double imaginary : {0.0, 1e-300, 1e-12, 1e-3, 1.0, 1e3}) {
                const Complex m(real, imaginary);
                if (std::abs(m) * x > 2e7) {
                    continue;  // correct too, but it takes a second each
                }
                const MieEfficiencies q = sphere_efficiencies(x, m, series);
                for (const double value : {q.q_ext, q.q_sca, q.q_abs, q.q_back, q.g}) {
                    ASSERT_TRUE(std::isfinite(value)) << x << m;
                }
                EXPECT_GE(q.q_sca, 0) << x << m;
                EXPECT_GE(q.q_abs, 0) << x << m;
                EXPECT_NEAR(q.q_ext, q.q_sca + q.q_abs, 1e-10 * q.q_ext + 1e-300) << x << m;
                EXPECT_LE(std::abs(q.g), 1) << x << m;
            }
        }
    }
}

TEST(MieSeries, OrdersAreThoseOfWiscombe) {
    EXPECT_EQ(count_mie_orders(0), 1u);
    EXPECT_EQ(count_mie_orders(1), 6u);
    EXPECT_EQ(count_mie_orders(100), 121u);
    EXPECT_EQ(count_mie_orders(1e4), 10089u);
    // What is left out is small: the last coefficients of any size.
    MieSeries series;
    for (const double x : {0.1, 1.0, 8.0, 8.1, 100.0, 4199.0, 4201.0, 1e4}) {
        expand_sphere(x, 1.5, series);
        EXPECT_LT(std::abs(series.a.back()) + std::abs(series.b.back()), 5e-7) << x;
    }
}

TEST(MieSeries, SpheresOutOfRangeAreRefusedAndNanIs) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double x : {0.0, -1.0, 1e-13, 1.1e6, nan, infinite}) {
        EXPECT_FALSE(check_sphere(x, 1.5)) << x;
    }
    for (const Complex m : {Complex(0, 0), Complex(-1.5, 0), Complex(1.5, -0.1), Complex(nan, 0),
                            Complex(1.5, nan), Complex(infinite, 0), Complex(1.5, 1001)}) {
        EXPECT_FALSE(check_sphere(1, m)) << m;
    }
    EXPECT_TRUE(check_sphere(1e6, {1000, 1000}));
    EXPECT_EQ(check_sphere(-1, 1.5).error().kind, formats::ErrorKind::usage);
}

}  // namespace
}  // namespace opaline::bake
