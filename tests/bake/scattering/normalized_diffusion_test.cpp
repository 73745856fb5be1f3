#include "bake/scattering/profile.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/reference_table.h"

namespace opaline::bake {
namespace {

DiffusionLength length_of(const tests::ReferenceRow& row) {
    return std::map<std::string, DiffusionLength>{
        {"searchlight", DiffusionLength::mean_free_path_searchlight},
        {"diffuse", DiffusionLength::mean_free_path_diffuse},
        {"dmfp", DiffusionLength::diffuse_mean_free_path}}
        .at(row.input.at("param"));
}

TEST(NormalizedDiffusion, ShapeProfileAndIntegralAreThoseOfTheTable) {
    OPALINE_REFERENCE_ROWS(shapes, "translucency.csv", "nd_s");
    OPALINE_REFERENCE_ROWS(profiles, "translucency.csv", "nd_R");
    OPALINE_REFERENCE_ROWS(integrals, "translucency.csv", "nd_cdf");
    for (const auto& row : shapes) {
        EXPECT_NEAR(normalized_diffusion_shape(row.number("albedo"), length_of(row)), row.expected,
                    row.tolerance())
            << row.name();
    }
    const auto profile = [](const tests::ReferenceRow& row) {
        return make_normalized_diffusion(row.number("albedo"), row.number("mfp"), length_of(row));
    };
    for (const auto& row : profiles) {
        EXPECT_NEAR(eval_normalized_diffusion(profile(row), row.number("r")), row.expected,
                    row.tolerance())
            << row.name();
    }
    for (const auto& row : integrals) {
        // The table's integral is of the profile with total 1.
        const auto p = profile(row);
        EXPECT_NEAR(normalized_diffusion_within(p, row.number("r")) / p.albedo, row.expected,
                    row.tolerance())
            << row.name();
    }
}

TEST(NormalizedDiffusion, TotalIsTheAlbedo) {
    const auto p = make_normalized_diffusion(0.63, 2, DiffusionLength::mean_free_path_diffuse);
    EXPECT_NEAR(normalized_diffusion_within(p, 1e4), 0.63, 1e-12);
}

}  // namespace
}  // namespace opaline::bake
