#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "bake/physics/dipole.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/profile.h"
#include "tests/bake/scattering/table_support.h"

namespace opaline::bake {
namespace {

using tests::expect_rows;
using tests::ReferenceRow;

Dipole dipole_of(const ReferenceRow& row, DipoleKind kind) {
    return make_dipole(kind, row.number("sigma_s_prime"), row.number("sigma_a"), row.number("eta"));
}

TEST(Dipole, ProfilesAreThoseOfTheTable) {
    for (const auto& [check, kind] : {std::pair{"dipole_Rd_exact", DipoleKind::classic},
                                      {"dipole_Rd_fit", DipoleKind::classic_fitted},
                                      {"better_Rd", DipoleKind::better}}) {
        expect_rows(check, [kind = kind](const ReferenceRow& row) {
            return eval_dipole(dipole_of(row, kind), row.number("r"));
        });
    }
}

TEST(Dipole, TotalsAreThoseOfTheTable) {
    for (const auto& [check, kind] : {std::pair{"dipole_total_exact", DipoleKind::classic},
                                      {"dipole_total_fit", DipoleKind::classic_fitted},
                                      {"better_total", DipoleKind::better}}) {
        expect_rows(check, [kind = kind](const ReferenceRow& row) {
            return dipole_total(dipole_of(row, kind));
        });
    }
}

TEST(Dipole, ClosedFormsAreThoseOfTheTable) {
    expect_rows("dipole_sigma_tr", [](const ReferenceRow& row) {
        return dipole_of(row, DipoleKind::classic).sigma_tr;
    });
    expect_rows("dipole_tail_exact", [](const ReferenceRow& row) {
        return dipole_tail(dipole_of(row, DipoleKind::classic), row.number("r"));
    });
    expect_rows("dipole_disc_mean_exact", [](const ReferenceRow& row) {
        return dipole_disc_mean(dipole_of(row, DipoleKind::classic), row.number("radius"));
    });
    expect_rows("dipole_hankel_exact", [](const ReferenceRow& row) {
        return dipole_fourier(dipole_of(row, DipoleKind::classic), row.number("k"));
    });
    // On a sphere the area within chord r is pi r^2 exactly: int R_d dA = R - tail(2 q).
    expect_rows("sphere_int_Rd", [](const ReferenceRow& row) {
        const Dipole dipole = dipole_of(row, DipoleKind::classic);
        return dipole_total(dipole) - dipole_tail(dipole, 2 * row.number("radius"));
    });
}

TEST(Dipole, BoundaryConstantsAreThoseOfTheTable) {
    const auto boundary = [](const ReferenceRow& row, DipoleKind kind) {
        const Dipole d = make_dipole(kind, 1, 0, row.number("eta"));
        return 0.75 * (d.z_virtual / d.z_real - 1);  // z_v = z_r (1 + 4 A / 3) for sigma_a = 0
    };
    expect_rows("A_classic_fit",
                [&](const ReferenceRow& row) { return boundary(row, DipoleKind::classic_fitted); });
    expect_rows("A_classic_exact",
                [&](const ReferenceRow& row) { return boundary(row, DipoleKind::classic); });
    expect_rows("A_better",
                [&](const ReferenceRow& row) { return boundary(row, DipoleKind::better); });
}

TEST(Dipole, WithoutAbsorptionEverythingComesBack) {
    for (const DipoleKind kind : {DipoleKind::classic, DipoleKind::better}) {
        for (const double eta : {0.7, 1.0, 1.3, 1.5, 3.0}) {
            EXPECT_NEAR(dipole_total(make_dipole(kind, 2.0, 0.0, eta)), 1, 1e-12);
        }
    }
}

TEST(Dipole, FallsWithDistanceAndStaysFinite) {
    for (const DipoleKind kind : {DipoleKind::classic, DipoleKind::better}) {
        for (const double scale : {1e-6, 1.0, 1e6}) {
            for (const double absorption : {0.0, 1e-9, 0.1, 100.0}) {
                const Dipole d = make_dipole(kind, scale, scale * absorption, 1.4);
                double before = eval_dipole(d, 0);
                ASSERT_TRUE(std::isfinite(before));
                for (double r = 1e-3 / scale; r < 1e5 / scale; r *= 1.5) {
                    const double value = eval_dipole(d, r);
                    ASSERT_TRUE(value >= 0 && value <= before) << r;
                    before = value;
                }
            }
        }
    }
}

TEST(Dipole, MediumThatDoesNotScatterIsBlack) {
    for (const double sigma_a : {0.0, 1.0}) {
        const Dipole d = make_dipole(DipoleKind::better, 0, sigma_a, 1.3);
        EXPECT_EQ(eval_dipole(d, 0), 0);
        EXPECT_EQ(dipole_total(d), 0);
        EXPECT_EQ(dipole_fourier(d, 1), 0);
    }
}

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

DiffusionLength length_of(const tests::ReferenceRow& row) {
    return std::map<std::string, DiffusionLength>{
        {"searchlight", DiffusionLength::mean_free_path_searchlight},
        {"diffuse", DiffusionLength::mean_free_path_diffuse},
        {"dmfp", DiffusionLength::diffuse_mean_free_path}}
        .at(row.input.at("param"));
}

TEST(NormalizedDiffusion, ShapeProfileAndIntegralAreThoseOfTheTable) {
    using Row = tests::ReferenceRow;
    const auto profile = [](const Row& row) {
        return make_normalized_diffusion(row.number("albedo"), row.number("mfp"), length_of(row));
    };
    tests::expect_rows("nd_s", [](const Row& row) {
        return normalized_diffusion_shape(row.number("albedo"), length_of(row));
    });
    tests::expect_rows("nd_R", [&](const Row& row) {
        return eval_normalized_diffusion(profile(row), row.number("r"));
    });
    // The table's integral is of the profile with total 1.
    tests::expect_rows("nd_cdf", [&](const Row& row) {
        const auto p = profile(row);
        return normalized_diffusion_within(p, row.number("r")) / p.albedo;
    });
}

TEST(NormalizedDiffusion, TotalIsTheAlbedo) {
    const auto p = make_normalized_diffusion(0.63, 2, DiffusionLength::mean_free_path_diffuse);
    EXPECT_NEAR(normalized_diffusion_within(p, 1e4), 0.63, 1e-12);
}

}  // namespace

}  // namespace opaline::bake
