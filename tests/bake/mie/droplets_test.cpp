#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "bake/physics/mie/droplet_optics.h"
#include "bake/physics/mie/droplets.h"
#include "bake/physics/mie/phase_texture.h"
#include "bake/physics/mie/refractive_index.h"
#include "tests/bake/mie/mie_support.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

// <r^power>
double mean_radius_power(const DropletDistribution& droplets, double power) {
    return std::exp(power * std::log(characteristic_radius(droplets)) +
                    std::lgamma(droplets.gamma + power) - std::lgamma(droplets.gamma));
}

TEST(Droplets, MomentsAreThoseOfTheGammaDistribution) {
    const DropletDistribution d = tests::paper_droplets();
    EXPECT_NEAR(characteristic_radius(d), 1.75e-6, 1e-18);
    const double r_n = 1.75e-6;
    EXPECT_NEAR(mean_radius_power(d, 0), 1, 1e-12);
    EXPECT_NEAR(mean_radius_power(d, 1) / (2 * r_n), 1, 1e-12);
    EXPECT_NEAR(mean_radius_power(d, 2) / (6 * r_n * r_n), 1, 1e-12);
    EXPECT_NEAR(mean_radius_power(d, 3) / mean_radius_power(d, 2) / d.effective_radius, 1, 1e-12);
    EXPECT_NEAR(mean_geometric_section(d) * 1e12, 57.726765, 1e-6);
    EXPECT_NEAR(liquid_water_content(d) * 1e3, 0.1616, 5e-5);  // grams
}

// From a singularity at radius 0 to overflow. Forward intensity carries r^4, and beyond the last
// radius there is next to nothing of it.
TEST(Droplets, RadiiHaveTheMomentsOfTheirDistributionForEveryGamma) {
    for (const double gamma : {0.1, 0.5, 0.99, 1.0, 2.0, 30.0, 171.0, 172.0, 1000.0, 10000.0}) {
        const DropletDistribution d{1e8, 5e-6, gamma};
        const RadiusRange range = radius_range(d);
        EXPECT_NEAR(pi * mean_radius_power(d, 2) / mean_geometric_section(d), 1, 1e-9) << gamma;
        double moment[5] = {}, last = range.least;
        for (const RadiusNode& node : place_radii(d, 4000)) {
            ASSERT_TRUE(std::isfinite(node.share));
            EXPECT_GT(node.radius, last);
            last = node.radius;
            for (int k = 0; k < 5; ++k)
                moment[k] += node.share * std::pow(node.radius, k);
        }
        EXPECT_LT(last, range.most);
        for (int k = gamma < 1 ? 2 : 0; k < 5; ++k) {
            EXPECT_NEAR(moment[k] / mean_radius_power(d, k), 1, k < 4 && gamma <= 2 ? 1e-4 : 1e-5)
                << gamma << " r^" << k;
        }
    }
    const DropletDistribution d = tests::paper_droplets();
    EXPECT_NEAR(radius_range(d).most / characteristic_radius(d), 33.6, 0.01);
}

TEST(Droplets, NarrowDistributionsAreKnown) {
    EXPECT_GT(relative_width(tests::paper_droplets()), kMonodisperse);
    EXPECT_LT(relative_width({1e8, 5e-6, 400}), kMonodisperse);
}

TEST(Droplets, DistributionsOutOfRangeAreRefused) {
    EXPECT_TRUE(check_droplets(tests::paper_droplets()));
    for (const double bad : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
        EXPECT_FALSE(check_droplets({bad, 7e-6, 2}));
        EXPECT_FALSE(check_droplets({3e8, bad, 2}));
        EXPECT_FALSE(check_droplets({3e8, 7e-6, bad}));
    }
    EXPECT_FALSE(check_droplets({3e8, 7e-6, 10001}));
    EXPECT_FALSE(check_droplets({3e8, 7e-6, 0.05}));
}

std::complex<double> index_of(Substance substance, double nm) {
    const auto index = refractive_index(substance, nm * 1e-9);
    EXPECT_TRUE(index.has_value()) << nm;
    return index ? index.value() : 0;
}

TEST(RefractiveIndex, RowsOfThePublishedTablesComeBackAsTheyAre) {
    for (const auto& [nm, real, imaginary] : {std::tuple{450.0, 1.337, 1.02e-9},
                                              {475.0, 1.336, 9.35e-10},
                                              {500.0, 1.335, 1.00e-9},
                                              {525.0, 1.334, 1.32e-9},
                                              {550.0, 1.333, 1.96e-9},
                                              {575.0, 1.333, 3.60e-9},
                                              {600.0, 1.332, 1.09e-8},
                                              {625.0, 1.332, 1.39e-8},
                                              {650.0, 1.331, 1.64e-8},
                                              {675.0, 1.331, 2.23e-8},
                                              {700.0, 1.331, 3.35e-8}}) {
        EXPECT_EQ(index_of(Substance::water, nm).real(), real) << nm;
        EXPECT_NEAR(index_of(Substance::water, nm).imag(), imaginary, 1e-22) << nm;
    }
    EXPECT_EQ(index_of(Substance::ice, 550).real(), 1.3110);
    EXPECT_NEAR(index_of(Substance::ice, 450).imag(), 9.239e-11, 1e-22);
}

TEST(RefractiveIndex, IsLinearBetweenRows) {
    const auto index = index_of(Substance::water, 560);
    EXPECT_NEAR(index.real(), 1.333, 1e-12);
    EXPECT_NEAR(index.imag(), 0.6 * 1.96e-9 + 0.4 * 3.60e-9, 1e-18);
    EXPECT_NEAR(index_of(Substance::ice, 455).real(), (1.3157 + 1.3151) / 2, 1e-9);
}

TEST(RefractiveIndex, NormalDispersionInVisibleLightAndIceIsThinnerThanWater) {
    for (double nm = 405; nm < 795; nm += 5) {
        for (const Substance substance : {Substance::water, Substance::ice}) {
            EXPECT_LE(index_of(substance, nm + 5).real(), index_of(substance, nm).real()) << nm;
            EXPECT_GT(index_of(substance, nm).imag(), 0) << nm;
        }
        EXPECT_LT(index_of(Substance::ice, nm).real(), index_of(Substance::water, nm).real());
    }
}

TEST(RefractiveIndex, WavelengthsOutsideOfTheTableAreRefused) {
    struct Table {
        Substance substance;
        double least, most;
    };
    for (const auto& [substance, least, most] :
         {Table{Substance::water, 300e-9, 1000e-9}, Table{Substance::ice, 400e-9, 800e-9}}) {
        EXPECT_TRUE(refractive_index(substance, least));
        EXPECT_TRUE(refractive_index(substance, most));
        for (const double bad : {least - 1e-9, most + 1e-9, 0.0, -1.0, 550.0,
                                 static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
            const auto index = refractive_index(substance, bad);
            ASSERT_FALSE(index) << bad;
            EXPECT_EQ(index.error().kind, formats::ErrorKind::usage);
        }
    }
}

TEST(PhaseTexture, CoordinateIsTheInverseOfTheAngle) {
    EXPECT_EQ(texture_angle(0), 0);
    EXPECT_NEAR(texture_angle(1), pi, 1e-15);
    for (double u = 0; u <= 1; u += 1.0 / 512) {
        EXPECT_NEAR(texture_coordinate(texture_angle(u)), u, 1e-7) << u;
    }
    for (const double angle : {0.0, 1e-12, 1e-4, 1.0, pi - 1e-4, pi}) {
        EXPECT_NEAR(texture_angle(texture_coordinate(angle)), angle, 1e-12) << angle;
    }
}

TEST(PhaseTexture, IntegratesTo1AndStoresWhatItWasScaledBy) {
    const DropletOptics& optics = tests::fine_optics();
    for (const unsigned texels : {64u, 256u, 1024u}) {
        const PhaseTexture texture = make_phase_texture(optics.phase, texels);
        EXPECT_EQ(texture.log_value.size(), texels);
        double sum = 0;
        constexpr int kSteps = 20000;
        for (int i = 0; i < kSteps; ++i) {
            const double angle = pi * (i + 0.5) / kSteps;
            sum += 2 * pi * std::sin(angle) * pi / kSteps * eval_texture(texture, angle);
        }
        EXPECT_NEAR(sum, 1, 1e-5) << texels;
        EXPECT_NEAR(texture.integral, 1, 20.0 / (texels * texels)) << texels;
    }
}

}  // namespace

}  // namespace opaline::bake
