#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/reference/reference_receivers.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"
#include "tests/support/sheets.h"

// Where theory says that the bake and the Monte Carlo reference are the same, they are.

namespace opaline::bake {
namespace {

// Of the self-checks of several seeds: one has 32 receivers, and in two of twelve none of them is
// at an edge of a shadow, where most of the error is.
double stated_error(const tests::Scene& scene, BakeOptions options) {
    constexpr int kSeeds = 4;
    double squares = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
        options.seed = static_cast<std::uint64_t>(seed);
        squares +=
            std::pow(tests::bake_scene(scene, options).error.at_receivers.rms_relative, 2) / kSeeds;
    }
    return std::sqrt(squares);
}

// Direct light on opaque surfaces: the file's own numerical error, measured by itself, is all.
TEST(ReferenceAgreement, DirectLightOnConvexAndConcaveOpaqueBodies) {
    BakeOptions options = tests::small_bake();
    options.cubemap_size = 32;
    options.effects = {"direct"};
    for (const tests::Scene& scene :
         {tests::make_scene({tests::make_sphere(3)}), tests::make_dented_ball()}) {
        const BakeResult baked = tests::bake_scene(scene, options);
        const auto report = check_model(scene, baked.asset.view(), {}, {}).value();
        EXPECT_TRUE(report.left_out.empty());
        ASSERT_EQ(report.by_light.size(), 6u) << "nothing refracts: every test light";
        // Both measure one error, at receivers of their own.
        const double stated = stated_error(scene, options);
        EXPECT_GE(stated, report.ci95[0]);
        EXPECT_LE(stated, report.ci95[1]);
        for (std::size_t l = 0; l < 6; ++l) {
            const ModelErrorReport::Part& model = report.by_light[l];
            const ErrorReport::Part& numerical = baked.error.at_receivers.by_light[l];
            ASSERT_EQ(model.name, numerical.name);
            if (model.name.starts_with("sun:")) {
                continue;  // a few receivers at the edges of shadows make the sum
            }
            EXPECT_LT(model.rms_relative, numerical.rms_relative + 0.7 * model.noise) << model.name;
            EXPECT_LT(std::abs(model.bias), numerical.rms_relative + model.noise) << model.name;
        }
    }
}

// With an index of 1 light enters straight: single scattering has no model left, but the degree
// that the phase function is cut at.
TEST(ReferenceAgreement, SingleScatteringThatEntersStraight) {
    for (const float g : {0.0f, 0.4f}) {
        formats::Medium medium = tests::make_grey_medium(3, 1, 1);
        medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
        medium.phase.g = g;
        const tests::Scene scene = tests::make_translucent_scene({tests::make_sphere(3)}, medium);
        BakeOptions options = tests::only({"single"});
        options.quality = Quality::production;
        options.cubemap_size = 16;
        options.set(kDepthSamples, 8);
        options.set(kPhaseTerms, g > 0 ? 25 : 1);
        const BakeResult baked = tests::bake_scene(scene, options);
        ModelCheckOptions wanted;
        wanted.simulated = TermSet::single;
        wanted.noise = 0.02;
        const auto report = check_model(scene, baked.asset.view(), wanted, {}).value();
        for (const char* soft : {"white", "studio"}) {
            const auto light =
                std::ranges::find(report.by_light, soft, &ModelErrorReport::Part::name);
            ASSERT_NE(light, report.by_light.end()) << soft;
            EXPECT_LT(light->rms_relative, g > 0 ? 0.03 : 0.02) << soft << " g " << g;
            EXPECT_LT(std::abs(light->bias), 0.01 + light->noise) << soft << " g " << g;
        }
    }
}

// Radiance toward the normal in the middle of a sheet's upper face, under a sky.
struct Middle {
    double baked = 0, truth = 0, standard_error = 0;
};

Middle look_at_middle(float thickness, const formats::Medium& medium, const char* effect,
                      TermSet terms) {
    constexpr std::uint32_t kCells = 8, kMiddle = (kCells / 2) * (kCells + 2);
    const tests::Scene scene =
        tests::make_translucent_scene(tests::make_sheet(thickness, kCells), medium);
    BakeOptions options = tests::only({effect});
    options.set(kSamples, 20000);
    options.set(kDepthSamples, 16);
    const BakeResult baked = tests::bake_scene(scene, options);
    const auto fixture = tests::make_fixture(scene, tests::make_white_sky());
    const auto receivers = choose_receivers(fixture->scene, 1u << 30, 0, std::nullopt);
    PathOptions paths;
    paths.terms = terms;
    EstimateOptions wanted;
    wanted.samples = 20000;
    const auto truth = estimate_receivers(fixture->space(paths),
                                          std::span(receivers).subspan(kMiddle, 1), wanted, {});
    Middle middle;
    middle.baked = static_cast<double>(tests::relight(baked.asset.view(), "white")[kMiddle].g);
    middle.truth = truth->pixel[0].mean.y;
    middle.standard_error = tests::standard_error(truth->pixel[0]);
    return middle;
}

// The middle of a slab forty mean free paths thick is a half space. There, under white light, the
// dipole is matched to a random walk's energy and errs in the direction of what leaves alone (1 to
// 3 % too bright along the normal), single scattering in the straight path behind a refracting
// boundary (0 to 3 % too dark).
TEST(ReferenceAgreement, DiffusionOnAThickFlatSlabUnderWhiteLight) {
    for (const float eta : {1.0f, 1.3f, 1.5f}) {
        const formats::Medium medium = tests::make_grey_medium(95, 5, eta);
        for (const auto& [effect, terms] :
             {std::pair{"multiple", TermSet::multiple}, {"single", TermSet::single}}) {
            const Middle m = look_at_middle(0.4f, medium, effect, terms);
            EXPECT_LT(m.standard_error, 0.035 * m.truth);
            EXPECT_NEAR(m.baked / m.truth, 1, 0.03 + 3 * m.standard_error / m.truth)
                << effect << " eta " << eta;
        }
    }
}

}  // namespace
}  // namespace opaline::bake
