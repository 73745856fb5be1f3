#include "bake/multiple/medium_profile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/scattering/fresnel.h"
#include "bake/scattering/half_space_walk.h"

namespace opaline::bake {
namespace {

using formats::Medium;

Medium make_medium(formats::Rgb sigma_s, formats::Rgb sigma_a, float eta) {
    Medium medium;
    medium.sigma_s = sigma_s;
    medium.sigma_a = sigma_a;
    medium.eta = eta;
    return medium;
}

TEST(MediumProfile, TableAgreesWithTheDipole) {
    const MediumProfile p =
        make_medium_profile(make_medium({2190, 2620, 3000}, {2.1f, 4.1f, 7.1f}, 1.5f), 0.3, 0, {});
    for (double r = 0; r < 0.29; r = 1.3 * r + 1e-5) {
        const auto value = eval_profile(p, static_cast<float>(r * r));
        for (std::size_t band = 0; band < 3; ++band) {
            const double peak = eval_dipole(p.dipole[band], 0);
            const double exact = p.scale[band] * eval_dipole(p.dipole[band], r);
            EXPECT_NEAR(static_cast<double>(value[band]), exact, 2e-4 * exact + 1e-7 * peak) << r;
        }
    }
}

TEST(MediumProfile, HalfSpaceReturnsWhatTheRandomWalkDoes) {
    const MediumProfile p =
        make_medium_profile(make_medium({800, 500, 0}, {200, 500, 10}, 1.3f), 1, 0, {});
    const double escape = 1 - fresnel_moments(1.3f).external;
    EXPECT_NEAR(p.total(0) * escape, walk_half_space(0.8, 0, 1.3, 200000, 9, {}).multiple, 3e-3);
    EXPECT_NEAR(p.total(1) * escape, walk_half_space(0.5, 0, 1.3, 200000, 9, {}).multiple, 3e-3);
    EXPECT_EQ(p.total(2), 0) << "what does not scatter returns nothing";
}

TEST(MediumProfile, WithoutAbsorptionNothingIsLost) {
    // Multiple and single parts together are all that entered (translucency.md 7.6).
    for (const float eta : {1.0f, 1.3f, 1.5f}) {
        const MediumProfile p =
            make_medium_profile(make_medium({5, 5, 5}, {0, 0, 0}, eta), 1, 0, {});
        const double escape = 1 - fresnel_moments(static_cast<double>(eta)).external;
        const double single =
            walk_half_space(1e-3, 0, static_cast<double>(eta), 200000, 4, {}).single / 1e-3;
        EXPECT_NEAR(p.total(0) * escape + single, escape, 8e-3) << eta;
    }
}

TEST(MediumProfile, ClassicAndPaperAreLeftAsTheyAre) {
    Medium medium = make_medium({2190, 2620, 3000}, {2.1f, 4.1f, 7.1f}, 1.5f);
    medium.profile = Medium::Profile::classic;
    const MediumProfile classic = make_medium_profile(medium, 1, 0, {});
    EXPECT_NEAR(classic.total(0), 0.83031, 1e-4);
    EXPECT_NEAR(classic.exit, 1 - 0.091778, 1e-5);
    medium.fidelity = Medium::Fidelity::paper;
    EXPECT_EQ(make_medium_profile(medium, 1, 0, {}).exit, 1);
}

TEST(MediumProfile, AnisotropyReducesScattering) {
    Medium medium = make_medium({1000, 1000, 1000}, {1, 1, 1}, 1.3f);
    medium.profile = Medium::Profile::classic;
    medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.8f, 0, {}, {}};
    EXPECT_NEAR(make_medium_profile(medium, 1, 0, {}).smallest_z, 1 / 201.0, 1e-6);
}

}  // namespace
}  // namespace opaline::bake
