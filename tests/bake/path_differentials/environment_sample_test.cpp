#include "tests/bake/path_differentials/environment_sample.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

using tests::Vector;

TEST(EnvironmentSample, DirectionsAreDerivativesAndSpanTheirPdf) {
    tests::RandomInputs random(21);
    tests::ColumnErrors errors;
    tests::AreaErrors areas;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        TexelChoice texel;
        texel.s = random.uniform(-1, 0.9);
        texel.t = random.uniform(-1, 0.9);
        texel.width = 1.0 / 64;
        texel.column_start = random.uniform(0, 0.5);
        texel.column_mass = random.uniform(0.01, 0.5);
        texel.row_start = random.uniform(0, 0.5);
        texel.row_mass = random.uniform(0.01, 0.5);
        const double u = texel.column_start + random.uniform() * texel.column_mass;
        const double v = texel.row_start + random.uniform() * texel.row_mass;
        const EnvironmentSample at = sample_texel(texel, u, v);
        const auto direction = [&](auto du, auto dv) {
            using S = decltype(du + dv);
            const S s = S(texel.s) +
                        S(texel.width) / S(texel.column_mass) * (S(u) + du - S(texel.column_start));
            const S t =
                S(texel.t) + S(texel.width) / S(texel.row_mass) * (S(v) + dv - S(texel.row_start));
            return tests::normalized(Vector<S>{s, t, S(1)});
        };
        errors.add([&](auto d) { return direction(d, 0 * d); }, at.dD_du);
        errors.add([&](auto d) { return direction(0 * d, d); }, at.dD_dv);
        areas.add(at.dD_du, at.dD_dv, at.pdf);
        EXPECT_LT(std::abs(glm::dot(at.D, at.dD_du)), 1e-12);
    }
    tests::expect_derivatives(errors);
    EXPECT_LT(areas.largest, 1e-12);
}

TEST(EnvironmentSample, BrighterTexelsMoveLess) {
    TexelChoice dim{.s = 0, .t = 0, .width = 0.1, .column_mass = 0.01, .row_mass = 0.1};
    TexelChoice bright = dim;
    bright.column_mass = 0.5;
    EXPECT_NEAR(glm::length(sample_texel(dim, 0.005, 0.05).dD_du),
                50 * glm::length(sample_texel(bright, 0.25, 0.05).dD_du), 1e-12);
}

}  // namespace
}  // namespace opaline::bake
