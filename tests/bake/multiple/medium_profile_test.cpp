#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/effects/multiple/choose_model.h"
#include "bake/effects/multiple/medium_profile.h"
#include "bake/effects/multiple/sample_transport.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/slab/even_light.h"
#include "bake/receivers/surface_samples.h"
#include "tests/support/scenes.h"

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

double length(const SparseVector& vector) {
    double squares = 0;
    for (const float value : vector.value) {
        squares += static_cast<double>(value) * static_cast<double>(value);
    }
    return std::sqrt(squares);
}

// Half of the sky, weighted by the cosine: the mean over the sphere is 1/4. A row with all entries
// has the norm of the whole vector times the area of its sample, with and without shared rays.
TEST(SampleTransport, OfAConvexBodyIsTheCosineTimesTheAreaOfEachSample) {
    const formats::Scene scene = tests::make_scene({tests::make_sphere(2)});
    const auto rays = RayScene::build(scene, 1);
    const auto samples = sample_surface(scene, {0}, 150, 1, {});
    ASSERT_GT(samples.size(), SparseVectors::kPerBlock) << "more than one block";
    for (const bool share_rays : {false, true}) {
        const SampleTransport found =
            bake_sample_transport(*rays, samples, {16, 6 * 16 * 16, 1, share_rays}, {});
        ASSERT_EQ(found.rows.size(), samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i) {
            EXPECT_NEAR(found.mean[i], 0.25, 0.02) << i;
            const double whole =
                static_cast<double>(samples[i].area) * static_cast<double>(found.norm[i]);
            EXPECT_NEAR(length(found.rows[i]), whole, 1e-5 * whole) << i;
        }
    }
}

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

WalkCounts lose(std::uint64_t lost, std::uint64_t endless, double unfinished) {
    WalkCounts counts;
    counts.walks = 1000;
    counts.lost = lost;
    counts.endless = endless;
    counts.ends.unfinished[0] = unfinished;
    counts.ends.left[0] = 1000 - unfinished;
    return counts;
}

TEST(UnfinishedWalks, OfALittleLightNothingIsSaid) {
    EXPECT_FALSE(describe_unfinished("Wax", {}));
    EXPECT_FALSE(describe_unfinished("Wax", lose(3, 0, 0.9)));
}

TEST(UnfinishedWalks, HowMuchLightWhyAndWhatIsDoneAboutItIsStated) {
    const auto holes = describe_unfinished("Wax", lose(30, 0, 16));
    ASSERT_TRUE(holes);
    EXPECT_EQ(holes->where, "material 'Wax'");
    EXPECT_THAT(holes->fault,
                AllOf(HasSubstr("of 1000 random walks 30 leave through holes of its mesh: 1.6 %"),
                      HasSubstr("as bright as the rest"), Not(HasSubstr("too often"))));
    EXPECT_EQ(holes->remedy, "close the surface");
    const auto closed = describe_unfinished("Wax", lose(0, 20, 9));
    ASSERT_TRUE(closed);
    EXPECT_THAT(closed->fault, AllOf(HasSubstr("20 scatter too often"), Not(HasSubstr("holes"))));
    EXPECT_THAT(closed->remedy, HasSubstr("--check-model"));
    const auto mostly_hole = describe_unfinished("Wax", lose(700, 0, 600));
    ASSERT_TRUE(mostly_hole);
    EXPECT_THAT(mostly_hole->fault, AllOf(HasSubstr("60.0 %"), HasSubstr("is missing")));
}

}  // namespace

}  // namespace opaline::bake
