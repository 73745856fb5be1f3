#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "bake/physics/mie/mie_series.h"
#include "bake/physics/mie/sphere_scattering.h"
#include "tests/bake/mie/mie_support.h"
#include "tests/support/cloud_table.h"

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

using tests::MieAmplitudes;
using tests::sum_amplitudes;

TEST(SphereScattering, EfficienciesAreThoseOfTheTable) {
    OPALINE_CLOUD_ROWS(rows, "mie");
    for (const auto& row : rows) {
        const MieEfficiencies q =
            sphere_efficiencies(row.number("x"), {row.number("m_re"), row.number_or("m_im", 0)});
        const std::string& name = row.text("quantity");
        const double value = name == "Qext"          ? q.q_ext
                             : name == "Qsca"        ? q.q_sca
                             : name == "Qabs"        ? q.q_abs
                             : name == "g"           ? q.g
                             : name == "Qback_radar" ? q.q_back
                                                     : std::nan("");
        EXPECT_NEAR(value, row.value(), row.error()) << row.name();
    }
}

// [BohrenHuffman1983], appendix A: the example of a sphere of radius 0.525 um and index 1.55 at
// 0.6328 um, with the angles that its program prints: |S_1|^2 + |S_2|^2 relative to straight ahead,
// and the polarisation.
TEST(SphereScattering, BohrenAndHuffmansExampleIsAsPrinted) {
    const double x = 2 * pi * 0.525 / 0.6328;
    const MieEfficiencies q = sphere_efficiencies(x, 1.55);
    EXPECT_NEAR(q.q_ext, 3.10543, 1e-5);
    EXPECT_NEAR(q.q_sca, 3.10543, 1e-5);
    EXPECT_NEAR(q.q_back, 2.92534, 1e-5);
    EXPECT_NEAR(q.g, 0.63314, 1e-5);
    MieSeries series;
    expand_sphere(x, 1.55, series);
    struct Printed {
        double angle, intensity, polarisation;
    };
    const MieAmplitudes ahead = sum_amplitudes(series, 1);
    for (const Printed p : {Printed{9, 0.785390, -0.459811e-2},
                            {18, 0.356897, -0.458541e-1},
                            {27, 0.766119e-1, -0.364744},
                            {36, 0.355355e-1, -0.534997},
                            {72, 0.125959e-1, -0.831996},
                            {90, 0.124601e-1, 0.230462}}) {
        const MieAmplitudes s = sum_amplitudes(series, std::cos(p.angle * pi / 180));
        const double one = std::norm(s.s1), two = std::norm(s.s2);
        EXPECT_NEAR((one + two) / (std::norm(ahead.s1) + std::norm(ahead.s2)), p.intensity,
                    2e-6 * p.intensity)
            << p.angle;
        EXPECT_NEAR((one - two) / (one + two), p.polarisation, 2e-6) << p.angle;
    }
}

// Without absorption nothing is lost; extinction is what the forward amplitude says.
TEST(SphereScattering, OpticalTheoremHolds) {
    MieSeries series;
    for (const double x : {1e-9, 1e-3, 0.5, 3.0, 50.0, 777.0, 1e4}) {
        for (const double m : {0.3, 0.75, 1.0001, 1.333, 1.5, 4.0, 20.0}) {
            const MieEfficiencies q = sphere_efficiencies(x, m, series);
            EXPECT_NEAR(q.q_ext / q.q_sca, 1, 1e-12) << x << ' ' << m;
            EXPECT_EQ(q.q_abs, 0);
        }
        for (const Complex m : {Complex(1.333, 0), Complex(1.5, 0.01), Complex(2, 2)}) {
            const MieEfficiencies q = sphere_efficiencies(x, m, series);
            const Complex ahead = sum_amplitudes(series, 1).s1;
            EXPECT_NEAR(4 / (x * x) * ahead.real() / q.q_ext, 1, 1e-11) << x << m;
            const MieAmplitudes behind = sum_amplitudes(series, -1);
            EXPECT_NEAR(4 * std::norm(behind.s1) / (x * x) / q.q_back, 1, 1e-7) << x << m;
        }
    }
}

TEST(SphereScattering, ManyAnglesAtOnceAreThoseOneByOne) {
    MieSeries series;
    for (const double x : {0.3, 7.0, 300.0}) {
        expand_sphere(x, {1.333, 1e-8}, series);
        for (const double most : {0.3, 0.11, 0.05}) {
            const AngleGrid grid = make_angle_grid(0.002, most, 0.05);
            std::vector<double> sum(grid.size(), 1.0);
            add_intensities(series, grid, 0.5, sum);
            for (std::size_t i = 0; i < grid.size(); ++i) {
                const MieAmplitudes s = sum_amplitudes(series, std::cos(grid.angle(i)));
                const double intensity = (std::norm(s.s1) + std::norm(s.s2)) / 2;
                EXPECT_NEAR(sum[i] - 1, 0.5 * intensity, 1e-9 * (1 + intensity)) << x << ' ' << i;
            }
        }
    }
}

TEST(SphereScattering, AngleGridAscendsFrom0ToPiAndIsSymmetric) {
    const AngleGrid grid = make_angle_grid(1e-3, 0.02, 0.1);
    EXPECT_EQ(grid.angle(0), 0);
    EXPECT_EQ(grid.angle(grid.size() - 1), pi);
    for (std::size_t i = 0; i + 1 < grid.size(); ++i) {
        EXPECT_GT(grid.angle(i + 1), grid.angle(i));
        EXPECT_LT(grid.angle(i + 1) - grid.angle(i), 0.02 + 1e-12);
        EXPECT_NEAR(grid.angle(i) + grid.angle(grid.size() - 1 - i), pi, 1e-15);
    }
}

}  // namespace

}  // namespace opaline::bake
