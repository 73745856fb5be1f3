#include <gtest/gtest.h>

#include "bake/physics/slab/even_light.h"
#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

// A half space: nothing comes back from 150 mean free paths.
constexpr float kDepth = 150;

bake::Moments look_at_half_space(float albedo, float g, float eta, formats::TermSet terms,
                                 float cosine, std::uint32_t samples) {
    const auto half_space =
        make_fixture(make_slab(make_medium(1, albedo, g, eta), kDepth), make_half_sky(true));
    bake::PathOptions options;
    options.terms = terms;
    return look_down(half_space->space(options), 0.5f * kDepth, cosine, samples);
}

TEST(ReferenceHalfSpace, SingleAndMultipleScatteringAgreeWithThePublishedWalk) {
    struct Row {
        float eta, albedo;
        double single, multiple;
    };
    // physics/README.md, "Half space", the columns of the walk: standard error about 0.001.
    for (const Row& row : {Row{1.0f, 0.80f, 0.164, 0.178},
                           {1.3f, 0.30f, 0.0235, 0.0072},
                           {1.3f, 0.80f, 0.0629, 0.1188},
                           {1.3f, 0.95f, 0.0740, 0.3263},
                           {1.3f, 0.99f, 0.0777, 0.5540},
                           {1.5f, 0.80f, 0.0411, 0.0893},
                           {1.5f, 0.99f, 0.0509, 0.4909}}) {
        const auto expect_term = [&](formats::TermSet term, double expected, std::uint32_t count) {
            const bake::Moments m = look_at_half_space(row.albedo, 0, row.eta, term, 0, count);
            EXPECT_NEAR(m.mean.x, expected, 3 * std::hypot(standard_error(m), 0.001))
                << "eta " << row.eta << " albedo " << row.albedo;
        };
        expect_term(formats::TermSet::single, row.single, 48000);
        expect_term(formats::TermSet::multiple, row.multiple, 24000);
    }
}

TEST(ReferenceHalfSpace, AgreesWithTheBakesOwnForForwardScattering) {
    const bake::HalfSpaceReflectance half = bake::half_space_reflectance(0.95, 0.6, 1.4);
    const bake::Moments single =
        look_at_half_space(0.95f, 0.6f, 1.4f, formats::TermSet::single, 0, 80000);
    const bake::Moments multiple =
        look_at_half_space(0.95f, 0.6f, 1.4f, formats::TermSet::multiple, 0, 40000);
    EXPECT_NEAR(single.mean.x, half.once, 3 * standard_error(single) + 0.001);
    EXPECT_NEAR(multiple.mean.x, half.rest, 3 * std::hypot(standard_error(multiple), 0.0007));
}

TEST(ReferenceHalfSpace, TermsAddUpToEverything) {
    double sum = 0, variance = 0;
    for (const formats::TermSet term :
         {formats::TermSet::single, formats::TermSet::multiple, formats::TermSet::specular,
          formats::TermSet::unscattered, formats::TermSet::interreflection,
          formats::TermSet::diffuse}) {
        const bake::Moments m = look_at_half_space(0.9f, 0.3f, 1.4f, term, 0.7f, 32000);
        sum += m.mean.x;
        variance += m.variance_of_mean().x;
    }
    const bake::Moments all =
        look_at_half_space(0.9f, 0.3f, 1.4f, formats::TermSet::all, 0.7f, 32000);
    EXPECT_NEAR(sum, all.mean.x, 3 * std::sqrt(variance + all.variance_of_mean().x));
}

}  // namespace
}  // namespace opaline::tests
