#include "bake/physics/profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

TEST(BeamDiffusion, TailIsTheIntegralOfTheProfile) {
    const BeamDiffusion beam = make_beam_diffusion(1.0, 0.05, 1.3);
    double sum = 0, low = 1e-7;
    for (double high = 1.002e-7; high < 300; low = high, high *= 1.002) {
        sum += std::numbers::pi * (high * high - low * low) *
               eval_beam_diffusion(beam, 0.5 * (low + high));
    }
    EXPECT_NEAR(beam_diffusion_tail(beam, 0), sum, 2e-4 * sum);
    double beyond = 0;
    low = 1;
    for (double high = 1.001; high < 300; low = high, high *= 1.001) {
        beyond += std::numbers::pi * (high * high - low * low) *
                  eval_beam_diffusion(beam, 0.5 * (low + high));
    }
    EXPECT_NEAR(beam_diffusion_tail(beam, 1), beyond, 2e-4 * beyond);
}

TEST(BeamDiffusion, ReflectanceIsThatOfTheReferenceTable) {
    // physics/README.md, "Half space", column "beams": R (1 - F_ext), to its three or four
    // digits.
    struct Row {
        double eta, albedo, expected;
    };
    for (const Row& row : {Row{1.0, 0.80, 0.203}, Row{1.3, 0.30, 0.0091}, Row{1.3, 0.80, 0.1262},
                           Row{1.3, 0.95, 0.3361}, Row{1.3, 0.99, 0.5743}, Row{1.5, 0.80, 0.0915},
                           Row{1.5, 0.99, 0.4945}}) {
        const BeamDiffusion beam = make_beam_diffusion(row.albedo, 1 - row.albedo, row.eta);
        const double found = beam_diffusion_tail(beam, 0) * (1 - fresnel_moments(row.eta).external);
        EXPECT_NEAR(found, row.expected, 6e-4 + 2e-3 * row.expected) << row.eta << row.albedo;
    }
}

TEST(BeamDiffusion, WithoutScatteringThereIsNothing) {
    const BeamDiffusion black = make_beam_diffusion(0, 1, 1.3);
    EXPECT_EQ(eval_beam_diffusion(black, 0), 0);
    EXPECT_EQ(beam_diffusion_tail(black, 0), 0);
}

}  // namespace
}  // namespace opaline::bake
