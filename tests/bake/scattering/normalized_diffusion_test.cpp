#include "bake/physics/profile.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/bake/scattering/table_support.h"

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
