#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/physics/dipole.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

using formats::Medium;
using formats::Rgb;
using tests::all_finite;
using tests::bake_scene;
using tests::make_ball_on_floor;
using tests::make_grey_medium;
using tests::only;
using tests::relative_rms;
using tests::relight_primitive;
using tests::small_bake;

// Every number of the file is finite, and under white light of radiance 1 no vertex is brighter
// than physics allows. Shading turns NaN into black: the mean over the body, the first primitive,
// finds that where light is due.
struct Bounds {
    double least_mean, brightest;
};
void expect_sound(const BakeResult& result, Bounds bounds, const std::string& what) {
    EXPECT_TRUE(all_finite(result.asset)) << what;
    EXPECT_TRUE(std::isfinite(result.error.rms_relative)) << what;
    const std::vector<Rgb> radiance = relight_primitive(result.asset, "white");
    double sum = 0;
    for (const Rgb c : radiance) {
        EXPECT_LE(std::max({c.r, c.g, c.b}), bounds.brightest) << what;
        sum += double{c.r};
    }
    EXPECT_GE(sum / static_cast<double>(radiance.size()), bounds.least_mean) << what;
}

TEST(Coefficients, WithoutAbsorptionBrightButNoBrighterThanTheLight) {
    const BakeResult result =
        bake_scene(tests::make_translucent_scene({tests::make_sphere(3)}, make_grey_medium(100, 0)),
                   small_bake());
    // Along the normal single scattering is somewhat above its mean over directions.
    expect_sound(result, {0.9, 1.1}, "sigma_a = 0");
}

// The ball is ten mean free paths thick.
TEST(Coefficients, WithoutScatteringTheMirrorIsLeftAndWhatHardlyCrosses) {
    const BakeResult result = bake_scene(make_ball_on_floor(make_grey_medium(0, 5)), small_bake());
    expect_sound(result, {0, 2e-3}, "sigma_s = 0");
    EXPECT_FALSE(result.asset.openness.empty());
    // Named explicitly, nothing is simulated all the same.
    const BakeResult asked =
        bake_scene(make_ball_on_floor(make_grey_medium(0, 5)), only({"multiple", "single"}));
    expect_sound(asked, {0, 0}, "sigma_s = 0, asked for");
}

// Readers refuse such a medium (MediaErrors.MediumWithoutAnyCoefficientIsRefused).
TEST(Coefficients, WithoutAnyMediumAllLightCrossesAndNothingIsNan) {
    const auto ball = make_ball_on_floor(make_grey_medium(0, 0));
    // 1 but for codes of 8 bits, few coefficients and views between those of the fit.
    expect_sound(bake_scene(ball, small_bake()), {0.1, 1.02}, "clear");
    expect_sound(bake_scene(ball, only({"multiple", "single"})), {0, 0}, "nothing scatters");
}

TEST(Coefficients, OneBandMayBeBlackOrClear) {
    Medium medium;
    medium.sigma_s = {10, 10, 0};
    medium.sigma_a = {0.1f, 0, 3};
    const BakeResult result =
        bake_scene(make_ball_on_floor(medium), only({"multiple", "single", "specular"}));
    expect_sound(result, {0.3, 1}, "bands");
    for (const Rgb c : relight_primitive(result.asset, "white")) {
        EXPECT_GT(c.r, 0);
        EXPECT_GT(c.g, c.r);
        EXPECT_EQ(c.b, 0);
    }
}

TEST(Coefficients, RadianceGrowsWithoutAJumpAsTheAlbedoTendsToOne) {
    double before = 0;
    for (const float sigma_a : {1e-1f, 1e-3f, 1e-5f, 1e-8f, 1e-20f, 0.0f}) {
        const BakeResult result = bake_scene(
            tests::make_translucent_scene({tests::make_sphere(1)}, make_grey_medium(30, sigma_a)),
            only({"multiple"}));
        double mean = 0;
        for (const Rgb c : relight_primitive(result.asset, "white")) {
            mean += c.g / 42.0;
        }
        EXPECT_GT(mean, before - 1e-3) << sigma_a;
        // Beyond, what the ball absorbs is less than a per cent.
        if (sigma_a < 1e-3f) {
            EXPECT_LT(mean, 1.03 * before + 1e-3) << sigma_a;
        }
        before = mean;
    }
    EXPECT_LT(before, 1);
}

TEST(Profile, InItsCentreASampleGivesNoMoreThanTheTotal) {
    for (const auto kind : {Medium::Profile::classic, Medium::Profile::better,
                            Medium::Profile::beams, Medium::Profile::normalized}) {
        Medium medium = make_grey_medium(1000, 1);
        medium.profile = kind;
        const MediumProfile profile = make_medium_profile(medium);  // takes a while
        for (const double spacing_in_z : {0.1, 1.0, 10.0, 1e4}) {
            const double spacing = spacing_in_z * profile.smallest;
            const GatherProfile gather = make_gather_profile(profile, spacing, 1e3 * spacing);
            const double own = spacing * spacing * eval_far(gather, 0)[0] + gather.near_mass[0];
            EXPECT_TRUE(std::isfinite(own));
            EXPECT_LE(own, profile.total(0) * 1.0001) << spacing_in_z;
        }
    }
}

// The difference of the sources' potentials cancels in floats: 1e-3 beyond 10 z_v if written as it
// stands. What receivers read is a table of floats.
TEST(Profile, FarRangeOfTheBetterDipoleKeepsItsDigits) {
    Medium medium = make_grey_medium(1000, 1e-8f);
    medium.profile = Medium::Profile::better;
    const MediumProfile profile = make_medium_profile(medium);
    const Dipole d = std::get<Dipole>(profile.band[0]);
    const GatherProfile gather = make_gather_profile(profile, 1e-9, 1e3);
    for (const double r : {10.0, 100.0, 1e4, 1e5}) {
        const long double x = r * d.z_virtual, k = d.sigma_tr;
        const auto at = [&](long double z) { return std::sqrt(x * x + z * z); };
        const auto decay = [&](long double z) { return std::exp(-k * at(z)); };
        const auto flux = [&](long double z) {
            return z * (1 + k * at(z)) * decay(z) / (at(z) * at(z) * at(z));
        };
        const long double exact =
            d.w_phi * (decay(d.z_real) / at(d.z_real) - decay(d.z_virtual) / at(d.z_virtual)) +
            d.w_flux * (flux(d.z_real) + flux(d.z_virtual));
        EXPECT_NEAR(eval_dipole(d, static_cast<double>(x)) / static_cast<double>(exact), 1, 1e-9);
        // Between the table's steps, 64 an octave, values are interpolated.
        const auto r2 = static_cast<float>(x * x);
        const double found = eval_far(gather, r2)[0] / profile.scale[0];
        EXPECT_NEAR(found / static_cast<double>(exact), 1, 1e-3) << r;
    }
}

// A body far thinner than the mean free path: L = sigma_s d p 4 pi under white light, with d the
// way through it along the normal.
TEST(Thin, BodyShinesAsItScattersOnItsWayThrough) {
    for (const float sigma_s : {1e-2f, 1e-4f, 1e-6f}) {
        BakeOptions options = only({"single"});
        Medium medium = make_grey_medium(sigma_s, 0, 1);
        auto scene = tests::make_translucent_scene({tests::make_sphere(3)}, medium);
        options.cubemap_size = 16;
        const BakeResult result = bake_scene(scene, options);
        if (2 * sigma_s < 1.0f / 512) {
            EXPECT_FALSE(find_entry(result.plan, "single", 0)->on) << "not worth simulating";
            continue;
        }
        for (const Rgb c : relight_primitive(result.asset, "white")) {
            // Facets lie inside the sphere, light is absorbed twice on one length.
            ASSERT_NEAR(c.g, 2 * sigma_s, 0.03 * 2 * sigma_s);
        }
    }
}

TEST(Thin, MultipleScatteringOfABodyThinnerThanAMeanFreePathStaysBounded) {
    auto sheet = tests::make_cube(4, false);
    for (glm::vec3& p : sheet.position) {
        p.y *= 0.01f;
    }
    const BakeResult result = bake_scene(
        tests::make_translucent_scene({sheet}, make_grey_medium(1, 0.01f)), small_bake());
    // A half-space profile on both sides can return up to twice (multiple/README.md, "Limits").
    expect_sound(result, {0.1, 2}, "thin");
}

// Also where the mean free path is far below what coordinates of floats resolve.
TEST(Thick, MeanFreePathsOfAMillionthOfTheBodyAndLessGiveTheLimit) {
    BakeOptions options = only({"single", "multiple"});
    options.separate_terms = true;
    using Shown = std::array<std::vector<Rgb>, 2>;
    const auto at = [&](float sigma) {
        const BakeResult baked =
            bake_scene(tests::make_translucent_scene({tests::make_sphere(2)},
                                                     make_grey_medium(sigma, 0.01f * sigma)),
                       options);
        runtime::ShadeOptions single, multiple;
        single.terms = formats::TermSet::single;
        multiple.terms = formats::TermSet::multiple;
        return Shown{relight_primitive(baked.asset, "studio", 0, single),
                     relight_primitive(baked.asset, "studio", 0, multiple)};
    };
    const Shown limit = at(5e2f);
    for (const float sigma : {1e5f, 1e8f, 1e12f}) {
        const Shown shown = at(sigma);
        for (std::size_t effect = 0; effect < limit.size(); ++effect) {
            EXPECT_GT(tests::mean_green(limit[effect]), 0.01);
            EXPECT_LT(relative_rms(shown[effect], limit[effect]), 0.02) << effect << ' ' << sigma;
        }
    }
}

TEST(Phase, ForwardAndBackwardPeaksBakeToSoundRows) {
    for (const float g : {-0.99f, -0.9f, 0.9f, 0.99f}) {
        Medium medium = make_grey_medium(10, 0.1f);
        medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, g, 0, {}, {}};
        for (const std::uint32_t terms : {1u, 25u}) {
            if (terms == 1 && std::abs(g) < 0.95f) continue;  // fewer terms ring less
            BakeOptions options = small_bake();
            options.set(kPhaseTerms, terms);
            // 25 terms of a sharper peak ring below zero, which pixels show as black.
            const double least = std::abs(g) < 0.95f || terms == 1 ? 0.05 : 0;
            // The floor, which takes most of the time, is there with the sharpest peaks.
            const bool is_hardest = terms == 25 && std::abs(g) > 0.95f;
            const auto scene = is_hardest
                                   ? make_ball_on_floor(medium)
                                   : tests::make_translucent_scene({tests::make_sphere(2)}, medium);
            expect_sound(bake_scene(scene, options), {least, 1},
                         "g = " + std::to_string(g) + ", " + std::to_string(terms) + " terms");
        }
    }
}

}  // namespace
}  // namespace opaline::bake
