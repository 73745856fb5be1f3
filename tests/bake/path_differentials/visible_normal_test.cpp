#include "bake/path_differentials/visible_normal.h"

#include "bake/path_differentials/disk_map.h"
#include "bake/path_differentials/smooth_event.h"
#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

using tests::moved;
using tests::Vector;

/// Inputs of an event at a facet.
struct FacetInputs {
    glm::dvec3 w_i{0}, dw_i{0};
    MicrofacetWidths widths;
    double u = 0, v = 0, eta = 1;

    template <class S>
    Vector<S> normal(S du, S dv, S x) const {
        return tests::visible_normal<S>(moved(w_i, dw_i, x), widths.x, widths.y,
                                        tests::concentric_point<S>(S(u) + du, S(v) + dv));
    }
};

/// Away from where the textbook's sine has no digits, and from branches.
FacetInputs random_facet(tests::RandomInputs& random) {
    for (;;) {
        FacetInputs in;
        in.w_i = random.unit_facing({0, 0, 1}, 0.05);
        in.dw_i = random.change_of(in.w_i);
        in.widths = {random.uniform(0.05, 1), random.uniform(0.05, 1)};
        in.u = random.uniform();
        in.v = random.uniform(0.02, 0.97);
        in.eta = random.uniform(0.5, 0.9);
        const double q = map_to_disk(in.u, in.v).q;
        if (q > 0.02 && q < 0.97 && !tests::is_near_diagonal(in.u, in.v)) return in;
    }
}

/// D(m) G1(w) (w.m) / w.z of [Walter2007] over solid angle of m [1/sr].
double seen_density(const glm::dvec3& m, const glm::dvec3& w, const MicrofacetWidths& a) {
    const glm::dvec3 scaled(m.x / a.x, m.y / a.y, m.z), stretched(a.x * w.x, a.y * w.y, w.z);
    const double square = glm::dot(scaled, scaled);
    return 2 * glm::dot(w, m) /
           (std::numbers::pi * a.x * a.y * square * square * (w.z + glm::length(stretched)));
}

TEST(VisibleNormal, NormalsAreDerivativesAndSpanTheirPdf) {
    tests::RandomInputs random(16);
    tests::ColumnErrors own, older;
    tests::AreaErrors areas;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const FacetInputs in = random_facet(random);
        const VisibleNormal at = sample_visible_normal(in.w_i, in.widths, in.u, in.v);
        own.add([&](auto d) { return in.normal(d, 0 * d, 0 * d); }, at.dm_du);
        own.add([&](auto d) { return in.normal(0 * d, d, 0 * d); }, at.dm_dv);
        older.add([&](auto d) { return in.normal(0 * d, 0 * d, d); }, at.dm_dwi * in.dw_i);
        areas.add(at.dm_du, at.dm_dv, seen_density(at.m, in.w_i, in.widths));
    }
    tests::expect_derivatives(own, 1e-10, 2e-7);
    tests::expect_derivatives(older, 1e-9, 2e-7);
    EXPECT_LT(areas.largest, 1e-12);
}

TEST(VisibleNormal, ReflectedDirectionsAreDerivatives) {
    tests::RandomInputs random(18);
    tests::ColumnErrors reflected, refracted;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const FacetInputs in = random_facet(random);
        const VisibleNormal at = sample_visible_normal(in.w_i, in.widths, in.u, in.v);
        const glm::dvec3 dm = at.dm_dwi * in.dw_i;
        reflected.add(
            [&](auto d) {
                using S = decltype(d);
                return tests::mirrored<S>(moved(-in.w_i, -in.dw_i, d),
                                          in.normal<S>(0 * d, 0 * d, d));
            },
            make_mirror(-in.w_i, at.m).change(-in.dw_i, dm));
        refracted.add(
            [&](auto d) {
                using S = decltype(d);
                return tests::refracted<S>(moved(-in.w_i, -in.dw_i, d),
                                           in.normal<S>(0 * d, 0 * d, d), S(in.eta));
            },
            make_refraction(-in.w_i, at.m, in.eta)->change(-in.dw_i, dm));
    }
    tests::expect_derivatives(reflected, 1e-8, 3e-7);
    tests::expect_derivatives(refracted, 1e-8, 3e-7);
}

// Head-on the cap is the whole upper half of the sphere, and its middle has a limit.
TEST(VisibleNormal, HeadOnInTheMiddleIsTheSurfacesNormal) {
    const VisibleNormal at = sample_visible_normal({0, 0, 1}, {0.3, 0.3}, 0.5, 0.5);
    EXPECT_LT(glm::length(at.m - glm::dvec3(0, 0, 1)), 1e-15);
    const double product =
        glm::length(glm::cross(at.dm_du, at.dm_dv)) * seen_density(at.m, {0, 0, 1}, {0.3, 0.3});
    EXPECT_NEAR(product, 1, 1e-12);
    // Tilting the view by x tilts the stretched one by 0.3 x, its half by 0.15 x, m by 0.3 of that.
    EXPECT_LT(glm::length(at.dm_dwi * glm::dvec3(1, 0, 0) - glm::dvec3(0.045, 0, 0)), 1e-15);
}

}  // namespace
}  // namespace opaline::bake
