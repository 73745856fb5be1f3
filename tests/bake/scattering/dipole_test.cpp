#include "bake/physics/dipole.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/physics/fresnel.h"
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

}  // namespace
}  // namespace opaline::bake
