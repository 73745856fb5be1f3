#include "bake/path_differentials/visible_normal.h"

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
    Vector<S> normal(bool concentric, S du, S dv, S x) const {
        return tests::visible_normal<S>(moved(w_i, dw_i, x), widths.x, widths.y,
                                        tests::disk_point<S>(concentric, S(u) + du, S(v) + dv));
    }
};

/// Away from where the textbook's sine has no digits, and from branches.
FacetInputs random_facet(tests::RandomInputs& random, bool concentric) {
    for (;;) {
        FacetInputs in;
        in.w_i = random.unit_facing({0, 0, 1}, 0.05);
        in.dw_i = random.change_of(in.w_i);
        in.widths = {random.uniform(0.05, 1), random.uniform(0.05, 1)};
        in.u = random.uniform();
        in.v = random.uniform(0.02, 0.97);
        in.eta = random.uniform(0.5, 0.9);
        const DiskPoint at =
            map_to_disk(concentric ? DiskMap::concentric : DiskMap::polar, in.u, in.v);
        if (at.q > 0.02 && at.q < 0.97 && !(concentric && tests::is_near_diagonal(in.u, in.v))) {
            return in;
        }
    }
}

TEST(VisibleNormal, NormalsAreDerivatives) {
    tests::RandomInputs random(16);
    for (const bool concentric : {false, true}) {
        const DiskMap map = concentric ? DiskMap::concentric : DiskMap::polar;
        tests::ColumnErrors own, older;
        for (int i = 0; i < tests::kRandomCases; ++i) {
            const FacetInputs in = random_facet(random, concentric);
            const VisibleNormal at = sample_visible_normal(in.w_i, in.widths, map, in.u, in.v);
            own.add([&](auto d) { return in.normal(concentric, d, 0 * d, 0 * d); }, at.dm_du);
            own.add([&](auto d) { return in.normal(concentric, 0 * d, d, 0 * d); }, at.dm_dv);
            older.add([&](auto d) { return in.normal(concentric, 0 * d, 0 * d, d); },
                      at.dm_dwi * in.dw_i);
        }
        tests::expect_derivatives(own, 1e-10, 2e-7);
        tests::expect_derivatives(older, 1e-9, 2e-7);
    }
}

TEST(VisibleNormal, ReflectionsAndRefractionsSpanTheirPdf) {
    tests::RandomInputs random(17);
    for (const DiskMap map : {DiskMap::polar, DiskMap::concentric}) {
        tests::AreaErrors normals, reflections, refractions;
        for (int i = 0; i < tests::kRandomCases; ++i) {
            const FacetInputs in = random_facet(random, map == DiskMap::concentric);
            const VisibleNormal at = sample_visible_normal(in.w_i, in.widths, map, in.u, in.v);
            normals.add(at.dm_du, at.dm_dv, at.pdf);
            const glm::dvec3 still(0);
            const Mirror mirror = make_mirror(-in.w_i, at.m);
            reflections.add(mirror.change(still, at.dm_du), mirror.change(still, at.dm_dv),
                            pdf_of_reflection(at, in.w_i));
            const auto refraction = make_refraction(-in.w_i, at.m, in.eta);
            ASSERT_TRUE(refraction);  // into the denser side there always is one
            refractions.add(refraction->change(still, at.dm_du),
                            refraction->change(still, at.dm_dv),
                            pdf_of_refraction(at, in.w_i, refraction->refracted, in.eta));
        }
        EXPECT_LT(normals.largest, 1e-12);
        EXPECT_LT(reflections.largest, 1e-11);  // 1 / (w_i.m) near grazing
        EXPECT_LT(refractions.largest, 1e-11);
    }
}

TEST(VisibleNormal, ReflectedDirectionsAreDerivatives) {
    tests::RandomInputs random(18);
    tests::ColumnErrors reflected, refracted;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const FacetInputs in = random_facet(random, true);
        const VisibleNormal at =
            sample_visible_normal(in.w_i, in.widths, DiskMap::concentric, in.u, in.v);
        const glm::dvec3 dm = at.dm_dwi * in.dw_i;
        reflected.add(
            [&](auto d) {
                using S = decltype(d);
                return tests::mirrored<S>(moved(-in.w_i, -in.dw_i, d),
                                          in.normal<S>(true, 0 * d, 0 * d, d));
            },
            make_mirror(-in.w_i, at.m).change(-in.dw_i, dm));
        refracted.add(
            [&](auto d) {
                using S = decltype(d);
                return tests::refracted<S>(moved(-in.w_i, -in.dw_i, d),
                                           in.normal<S>(true, 0 * d, 0 * d, d), S(in.eta));
            },
            make_refraction(-in.w_i, at.m, in.eta)->change(-in.dw_i, dm));
    }
    tests::expect_derivatives(reflected, 1e-8, 3e-7);
    tests::expect_derivatives(refracted, 1e-8, 3e-7);
}

// Head-on the cap is the whole upper half of the sphere, and its middle has a limit.
TEST(VisibleNormal, HeadOnInTheMiddleIsTheSurfacesNormal) {
    const VisibleNormal at =
        sample_visible_normal({0, 0, 1}, {0.3, 0.3}, DiskMap::concentric, 0.5, 0.5);
    EXPECT_LT(glm::length(at.m - glm::dvec3(0, 0, 1)), 1e-15);
    const double product = glm::length(glm::cross(at.dm_du, at.dm_dv)) * at.pdf;
    EXPECT_NEAR(product, 1, 1e-12);
    // Tilting the view by x tilts the stretched one by 0.3 x, its half by 0.15 x, m by 0.3 of that.
    EXPECT_LT(glm::length(at.dm_dwi * glm::dvec3(1, 0, 0) - glm::dvec3(0.045, 0, 0)), 1e-15);
}

}  // namespace
}  // namespace opaline::bake
