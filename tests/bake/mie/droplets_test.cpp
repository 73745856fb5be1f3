#include "bake/physics/mie/droplets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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

}  // namespace
}  // namespace opaline::bake
