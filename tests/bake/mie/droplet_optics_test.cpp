#include "bake/physics/mie/droplet_optics.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "bake/physics/mie/sphere_scattering.h"
#include "tests/bake/mie/mie_support.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

using tests::MieAmplitudes;
using tests::sum_amplitudes;

using Complex = std::complex<double>;

DropletOptics average(const DropletDistribution& droplets, double wavelength, Complex index,
                      const RadiusSampling& sampling = {}) {
    auto optics = average_droplets(droplets, wavelength, index, sampling, {});
    EXPECT_TRUE(optics.has_value());
    return optics ? std::move(*optics) : DropletOptics{};
}

TEST(DropletOptics, PhaseFunctionIntegratesTo1AndHasTheMeanCosineOfTheCoefficients) {
    const DropletOptics& optics = tests::fine_optics();
    EXPECT_NEAR(integrate_table(optics.phase), 1, 1e-12);
    EXPECT_NEAR(optics.integral_before, 1, 1e-4);  // linear between rows
    EXPECT_NEAR(integrate_cosine(optics.phase), optics.g, 1e-4);
    EXPECT_NEAR(optics.c_ext, optics.c_sca + optics.c_abs, 1e-12 * optics.c_ext);
    EXPECT_GT(absorbed_share(optics), 0.01);
}

// Of nearly equal droplets the mean is a sphere.
TEST(DropletOptics, NarrowDistributionIsOneSphere) {
    const DropletDistribution narrow{1e8, 1e-7, 10000};
    const DropletOptics optics = average(narrow, 500e-9, 1.5);
    const double x = 2 * pi * 1e-7 / 500e-9;
    const MieEfficiencies q = sphere_efficiencies(x, 1.5);
    EXPECT_NEAR(optics.c_ext / (pi * 1e-14) / q.q_ext, 1, 2e-3);
    EXPECT_NEAR(optics.g / q.g, 1, 2e-3);
    MieSeries series;
    expand_sphere(x, 1.5, series);
    const double c_sca = q.q_sca * pi * 1e-14, k = 2 * pi / 500e-9;
    for (const double angle : {0.0, 0.7, 1.5, 3.0}) {
        const MieAmplitudes s = sum_amplitudes(series, std::cos(angle));
        const double p = (std::norm(s.s1) + std::norm(s.s2)) / (2 * k * k * c_sca);
        EXPECT_NEAR(eval_table(optics.phase, angle) / p, 1, 1e-2) << angle;
    }
}

// The estimate from even and odd radii is the error against many more radii, within a factor of 4.
TEST(DropletOptics, ErrorThatIsReportedIsTheErrorAgainstMoreRadii) {
    const DropletDistribution d{1e8, 2e-6, 3};
    const DropletOptics truth = average(d, 550e-9, 1.333, {0.005, 100, 8000});
    double last = 1;
    for (const double step : {0.4, 0.1}) {
        const DropletOptics coarse = average(d, 550e-9, 1.333, {step, 2, 8000});
        double squares = 0;
        for (std::size_t i = 0; i < coarse.phase.value.size(); ++i) {
            const double relative = coarse.phase.value[i] / truth.phase.value[i] - 1;
            squares += relative * relative;
        }
        const double rms = std::sqrt(squares / static_cast<double>(coarse.phase.value.size()));
        EXPECT_LT(coarse.error.phase_rms, 4 * rms) << step;
        EXPECT_GT(coarse.error.phase_rms, rms / 4) << step;
        EXPECT_LT(coarse.error.phase_rms, last) << step;
        EXPECT_GE(coarse.error.phase_max, coarse.error.phase_rms);
        last = coarse.error.phase_rms;
    }
}

// By row what the halves differ by, of which the RMS is reported; both integrate to 1.
TEST(DropletOptics, HalvesOfThePhaseFunctionDifferByItsErrorAndHoldTheSameLight) {
    const DropletOptics& optics = tests::fine_optics();
    ASSERT_EQ(optics.phase_error.angle, optics.phase.angle);
    EXPECT_NEAR(integrate_table(optics.phase_error), 0, 1e-12);
    double squares = 0;
    for (std::size_t i = 0; i < optics.phase.value.size(); ++i) {
        const double relative = optics.phase_error.value[i] / optics.phase.value[i];
        squares += relative * relative / static_cast<double>(optics.phase.value.size());
    }
    EXPECT_NEAR(std::sqrt(squares) / optics.error.phase_rms, 1, 0.05);
    // Of a channel: by the power that each wavelength scatters.
    const DropletOptics both[] = {optics, optics};
    const double weights[] = {1, 2};
    const DropletOptics channel = mix_wavelengths(both, weights);
    EXPECT_NEAR(channel.phase_error.value[7], optics.phase_error.value[7],
                1e-9 * std::abs(optics.phase_error.value[7]));
}

TEST(DropletOptics, ExtremeDistributionsAreFinite) {
    for (const DropletDistribution& d : {DropletDistribution{1e8, 1e-6, 0.1},
                                         {1e8, 1e-6, 10000},
                                         {1e-3, 1e-12, 2},
                                         {1e8, 1e-6, 171},
                                         {1e30, 1e-6, 1}}) {
        for (const Complex index : {Complex(1.333, 0), Complex(0.75, 0), Complex(1.5, 30)}) {
            const DropletOptics optics = average(d, 550e-9, index, {0.5, 50, 200});
            EXPECT_TRUE(std::isfinite(optics.c_ext) && optics.c_ext > 0) << d.gamma;
            EXPECT_TRUE(std::isfinite(optics.g) && std::abs(optics.g) < 1) << d.gamma;
            EXPECT_TRUE(std::isfinite(optics.error.phase_max));
            for (const double p : optics.phase.value) {
                ASSERT_TRUE(std::isfinite(p) && p >= 0) << d.gamma;
            }
            EXPECT_NEAR(integrate_table(optics.phase), 1, 1e-12);
        }
    }
}

TEST(DropletOptics, BadInputIsRefusedWithWhatIsWrong) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const DropletDistribution good{1e8, 1e-6, 2};
    const auto refuse = [&](const DropletDistribution& d, double wavelength, Complex index) {
        const auto optics = average_droplets(d, wavelength, index, {0.5, 2, 100}, {});
        ASSERT_FALSE(optics.has_value());
        EXPECT_EQ(optics.error().kind, formats::ErrorKind::usage);
        EXPECT_FALSE(optics.error().diagnostics.front().fault.empty());
    };
    refuse({1e8, nan, 2}, 550e-9, 1.333);
    refuse({1e8, 1e-6, 0}, 550e-9, 1.333);
    refuse(good, 0, 1.333);
    refuse(good, nan, 1.333);
    refuse(good, 550e-9, {1.333, -1});
    refuse(good, 550e-9, {nan, 0});
    refuse(good, 550e-9, 1);                 // no scattering: no phase function
    refuse({1e8, 1e-3, 2}, 550e-9, 1.333);   // geometric optics
    refuse({1e8, 1e-15, 2}, 550e-9, 1.333);  // nothing
}

TEST(DropletOptics, ChannelOfSeveralWavelengthsIsTheirMeanByScatteredPower) {
    const DropletDistribution d{1e8, 0.6e-6, 4};
    const DropletOptics one = average(d, 600e-9, {1.333, 0.001}), other = average(d, 400e-9, 1.34);
    const DropletOptics both[] = {one, other};
    const double weights[] = {1, 3};
    const DropletOptics channel = mix_wavelengths(both, weights);
    EXPECT_NEAR(channel.c_ext, (one.c_ext + 3 * other.c_ext) / 4, 1e-12 * one.c_ext);
    EXPECT_NEAR(channel.c_ext, channel.c_sca + channel.c_abs, 1e-12 * one.c_ext);
    EXPECT_NEAR(channel.wavelength, 450e-9, 1e-15);
    EXPECT_NEAR(integrate_table(channel.phase), 1, 1e-12);
    EXPECT_NEAR(integrate_cosine(channel.phase), channel.g, 1e-4);
    const double power = 3 * other.c_sca / (one.c_sca + 3 * other.c_sca);
    for (const double angle : {0.0, 0.1, 1.0, 2.0, pi}) {
        const double mean =
            (1 - power) * eval_table(one.phase, angle) + power * eval_table(other.phase, angle);
        EXPECT_NEAR(eval_table(channel.phase, angle) / mean, 1, 1e-4) << angle;
    }
    // Of one wavelength it is that one.
    const double all[] = {0, 1};
    EXPECT_EQ(mix_wavelengths(both, all).c_sca, other.c_sca);
}

TEST(DropletOptics, CancellationIsHeard) {
    const std::atomic<bool> cancel = true;
    Context context;
    context.cancel = &cancel;
    const auto optics = average_droplets({1e8, 1e-6, 2}, 550e-9, 1.333, {}, context);
    ASSERT_FALSE(optics.has_value());
    EXPECT_EQ(optics.error().kind, formats::ErrorKind::interrupted);
}

}  // namespace
}  // namespace opaline::bake
