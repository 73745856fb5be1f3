#include "bake/effects/multiple/medium_profile.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bake/effects/multiple/gather_profile.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/slab/even_light.h"

namespace opaline::bake {
namespace {

using formats::Medium;

using std::numbers::pi;

Medium make_medium(formats::Rgb sigma_s, formats::Rgb sigma_a, float eta) {
    Medium medium;
    medium.sigma_s = sigma_s;
    medium.sigma_a = sigma_a;
    medium.eta = eta;
    return medium;
}

TEST(GatherProfile, TableOfDenseSamplesIsTheProfileItself) {
    const MediumProfile p =
        make_medium_profile(make_medium({2190, 2620, 3000}, {2.1f, 4.1f, 7.1f}, 1.5f));
    const GatherProfile dense = make_gather_profile(p, 0.5 * p.smallest, 0.3);
    EXPECT_EQ(dense.near_radius, 0);
    for (double r = 0; r < 0.29; r = 1.3 * r + 1e-5) {
        const auto value = eval_far(dense, static_cast<float>(r * r));
        for (std::size_t band = 0; band < 3; ++band) {
            const double exact = p.eval(band, r);
            EXPECT_NEAR(static_cast<double>(value[band]), exact,
                        2e-4 * exact + 1e-7 * p.eval(band, 0))
                << r;
        }
    }
}

TEST(GatherProfile, FarAndNearPartTogetherAreTheTotal) {
    for (const Medium::Profile kind : {Medium::Profile::classic, Medium::Profile::better,
                                       Medium::Profile::beams, Medium::Profile::normalized}) {
        Medium medium = make_medium({900, 500, 2000}, {2, 50, 5}, 1.3f);
        medium.profile = kind;
        const MediumProfile p = make_medium_profile(medium);
        for (const double spacing : {0.3, 2.0, 30.0}) {
            const double h = spacing * p.smallest, reach = 3e4 * p.smallest;
            const GatherProfile split = make_gather_profile(p, h, reach);
            std::array<double, 3> sum{};
            double low = 0;
            for (double high = 1e-3 * h; high < reach; low = high, high *= 1.002) {
                const double r = 0.5 * (low + high);
                const auto value = eval_far(split, static_cast<float>(r * r));
                for (std::size_t b = 0; b < 3; ++b) {
                    sum[b] += static_cast<double>(value[b]) * pi * (high * high - low * low);
                }
            }
            for (std::size_t b = 0; b < 3; ++b) {
                EXPECT_NEAR(sum[b] + static_cast<double>(split.near_mass[b]), p.total(b),
                            3e-3 * p.total(b))
                    << static_cast<int>(kind) << " " << spacing << " " << b;
            }
        }
    }
}

TEST(MediumProfile, NormalizedDiffusionHasTheWholeResponse) {
    Medium medium = make_medium({800, 950, 100}, {200, 50, 900}, 1.3f);
    medium.profile = Medium::Profile::normalized;
    const MediumProfile p = make_medium_profile(medium);
    const double escape = 1 - fresnel_moments(1.3f).external;
    const auto returned = half_space_reflectance(0.8, 0, 1.3);
    EXPECT_NEAR(p.total(0) * escape, returned.once + returned.rest, 4e-3);
}

TEST(MediumProfile, HalfSpaceReturnsWhatTheSolverSays) {
    const MediumProfile p = make_medium_profile(make_medium({800, 500, 0}, {200, 500, 10}, 1.3f));
    const double escape = 1 - fresnel_moments(1.3f).external;
    EXPECT_NEAR(p.total(0) * escape, half_space_reflectance(0.8, 0, 1.3).rest, 3e-3);
    EXPECT_NEAR(p.total(1) * escape, half_space_reflectance(0.5, 0, 1.3).rest, 3e-3);
    EXPECT_EQ(p.total(2), 0) << "what does not scatter returns nothing";
}

TEST(MediumProfile, ClassicAndPaperAreLeftAsTheyAre) {
    Medium medium = make_medium({2190, 2620, 3000}, {2.1f, 4.1f, 7.1f}, 1.5f);
    medium.profile = Medium::Profile::classic;
    const MediumProfile classic = make_medium_profile(medium);
    EXPECT_NEAR(classic.total(0), 0.83031, 1e-4);
    EXPECT_NEAR(classic.exit, 1 - 0.091778, 1e-5);
    medium.fidelity = Medium::Fidelity::paper;
    EXPECT_EQ(make_medium_profile(medium).exit, 1);
}

TEST(MediumProfile, AnisotropyReducesScattering) {
    Medium medium = make_medium({1000, 1000, 1000}, {1, 1, 1}, 1.3f);
    medium.profile = Medium::Profile::classic;
    medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.8f, 0, {}, {}};
    EXPECT_NEAR(make_medium_profile(medium).smallest, 1 / 201.0, 1e-6);
}

// A body of 1 m^2 whose source lies 1 mm deep.
TEST(SampleCount, FollowsTheReceiversWhereTheyAreFartherApartThanLightSpreads) {
    const auto count = [](double per_path, double receivers) {
        return count_samples(1, 1e-3, {per_path, 1e5, receivers});
    };
    EXPECT_EQ(count(1, 1e6), 100000u) << "as many as are allowed";
    EXPECT_EQ(count(1, 4000), 20000u);
    EXPECT_EQ(count(4, 4000), 80000u);
    EXPECT_EQ(count(1, 36), 8000u) << "its parts shade each other, whatever the receivers";
    EXPECT_EQ(count_samples(1, 0.02, {1, 1e5, 36}), 2500u) << "light spreads farther";
    EXPECT_EQ(count_samples(1, 0, {1, 1e5, 36}), 2000u) << "nothing scatters";
    EXPECT_EQ(count_samples(1, 1e-3, {1, 500, 1e6}), 500u);
}

}  // namespace
}  // namespace opaline::bake
