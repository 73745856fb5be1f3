#include "bake/physics/mie/sphere_scattering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "tests/bake/mie/mie_support.h"
#include "tests/support/cloud_table.h"

namespace opaline::bake {
namespace {

using Complex = std::complex<double>;

using std::numbers::pi;

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
