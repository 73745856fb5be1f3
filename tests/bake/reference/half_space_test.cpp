#include <gtest/gtest.h>

#include "bake/slab/even_light.h"
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

// Radiance after one scattering under uniform light (single/README.md, "Transport") with its
// Jacobian and the true refracted view path: the integral over depth is 1 / (sigma_t (1 + mu_o' /
// c')).
double single_radiance(double albedo, double g, double eta, double view) {
    const double mu = std::sqrt(1 - (1 - view * view) / (eta * eta));
    const int steps = 2000, turns = g == 0 || view == 1 ? 1 : 200;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double c = (i + 0.5) / steps, ct = std::sqrt(1 - (1 - c * c) / (eta * eta));
        if (!(ct > 0)) continue;  // total reflection
        const double jacobian = c / (eta * eta * ct);
        for (int k = 0; k < turns; ++k) {
            const double phi = 2 * std::numbers::pi * (k + 0.5) / turns;
            const double cosine =
                -(ct * mu + std::sqrt((1 - ct * ct) * (1 - mu * mu)) * std::cos(phi));
            const double p =
                (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
            sum += p * transmittance(c, eta) * jacobian / (1 + mu / ct);
        }
    }
    return albedo * transmittance(view, eta) * 2 * std::numbers::pi * sum / (steps * turns);
}

TEST(ReferenceHalfSpace, SingleScatteringIsItsIntegralWithTheJacobian) {
    struct Case {
        double albedo, g, eta, view;
    };
    for (const Case& c : {Case{0.9, 0, 1, 1},
                          {0.9, 0, 1.3, 1},
                          {0.8, 0, 1.5, 0.3},
                          {0.8, 0.6, 1.3, 1},
                          {1, -0.5, 1.3, 0.4},
                          {1, 0.5, 1, 0.5},
                          {0.7, 0, 0.8, 0.9}}) {
        const bake::Moments m = look_at_half_space(
            static_cast<float>(c.albedo), static_cast<float>(c.g), static_cast<float>(c.eta),
            formats::TermSet::single, static_cast<float>(c.view), 320000);
        const double expected = single_radiance(c.albedo, c.g, c.eta, c.view);
        EXPECT_NEAR(m.mean.x, expected, 3 * standard_error(m))
            << "eta " << c.eta << " g " << c.g << " view " << c.view;
        EXPECT_LT(standard_error(m), 0.02 * expected);
    }
}

TEST(ReferenceHalfSpace, SingleAndMultipleScatteringAgreeWithThePublishedWalk) {
    struct Row {
        float eta, albedo;
        double single, multiple;
    };
    // scattering/README.md, "Half space", the columns of the walk: standard error about 0.001.
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
