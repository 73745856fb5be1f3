#include "bake/physics/path_differentials/lobe.h"
#include "bake/physics/path_differentials/surface_shape.h"
#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

/// The textbook's cosine of a lobe at q.
template <class S>
S textbook_cosine(const Lobe& lobe, S q) {
    switch (lobe.kind) {
        case Lobe::Kind::power:
            return tests::power_cosine(lobe.parameter, q);
        case Lobe::Kind::henyey_greenstein:
            return tests::henyey_greenstein_cosine(lobe.parameter, q);
        case Lobe::Kind::cone:
            return S(1) - q * S(1 - lobe.parameter);
        case Lobe::Kind::cap:
            break;
    }
    return S(1) - q * S(lobe.parameter);
}

/// The textbook's density over solid angle [1/sr].
double textbook_pdf(const Lobe& lobe, double cosine) {
    const double p = lobe.parameter, two_pi = 2 * std::numbers::pi;
    switch (lobe.kind) {
        case Lobe::Kind::power:
            return (p + 1) / two_pi * std::pow(cosine, p);
        case Lobe::Kind::henyey_greenstein:
            return (1 - p * p) / (2 * two_pi) * std::pow(1 + p * p - 2 * p * cosine, -1.5);
        case Lobe::Kind::cone:
            return 1 / (two_pi * (1 - p));
        case Lobe::Kind::cap:
            break;
    }
    return 1 / (two_pi * p);
}

/// Columns of random lobes against the textbook's direction, and area times pdf.
void check_lobes(Lobe::Kind kind, double least, double most, double tolerance) {
    tests::RandomInputs random(11);
    tests::ColumnErrors errors;
    tests::AreaErrors areas;
    double along = 0;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const Lobe lobe{kind, random.uniform(least, most)};
        const double u = random.uniform(0.001, 0.999), v = random.uniform(0.01, 0.98);
        if (tests::is_near_diagonal(u, v)) continue;
        const LobeDirection sample = sample_lobe(lobe, u, v);
        areas.add(sample.dD_du, sample.dD_dv, textbook_pdf(lobe, sample.D.z));
        along =
            std::max({along, std::abs(glm::dot(sample.D, sample.dD_du)) / glm::length(sample.dD_du),
                      std::abs(glm::length(sample.D) - 1)});
        const glm::dvec2 at(2 * u - 1, 2 * v - 1);
        if (at.x * at.x > 0.98 || at.y * at.y > 0.98 ||
            std::max(std::abs(at.x), std::abs(at.y)) < 0.1) {
            continue;  // the textbook's sine has no digits left there
        }
        const auto direction = [&](auto du, auto dv) {
            using S = decltype(du + dv);
            return tests::lobe_direction<S>(tests::concentric_point<S>(S(u) + du, S(v) + dv),
                                            [&](S q) { return textbook_cosine<S>(lobe, q); });
        };
        errors.add([&](auto d) { return direction(d, decltype(d)(0)); }, sample.dD_du);
        errors.add([&](auto d) { return direction(decltype(d)(0), d); }, sample.dD_dv);
    }
    tests::expect_derivatives(errors, tolerance);
    EXPECT_LT(areas.largest, 1e-10);
    EXPECT_LT(along, 1e-12);
}

TEST(Lobe, ColumnsAreDerivativesOfTheirDirections) {
    check_lobes(Lobe::Kind::power, 0, 60, 1e-10);
    check_lobes(Lobe::Kind::henyey_greenstein, 0.1, 0.95, 1e-9);
    check_lobes(Lobe::Kind::henyey_greenstein, -0.9, -0.1, 1e-9);
    check_lobes(Lobe::Kind::cone, -0.9, 0.95, 1e-10);
    check_lobes(Lobe::Kind::cap, 0.05, 1.95, 1e-10);
}

TEST(Lobe, LogarithmOfThePdfHasItsDerivative) {
    for (const Lobe& lobe :
         {Lobe{Lobe::Kind::power, 40}, Lobe{Lobe::Kind::power, 0},
          Lobe{Lobe::Kind::henyey_greenstein, 0.8}, Lobe{Lobe::Kind::henyey_greenstein, -0.6},
          Lobe{Lobe::Kind::cone, 0.5}, Lobe{Lobe::Kind::cap, 1.5}}) {
        for (const double q : {0.1, 0.5, 0.9}) {
            const double h = 1e-6;
            const auto log_pdf = [&](double at) {
                return std::log(textbook_pdf(lobe, eval_lobe(lobe, at).cosine));
            };
            const double slope = (log_pdf(q + h) - log_pdf(q - h)) / (2 * h);
            EXPECT_NEAR(eval_lobe(lobe, q).dln_pdf, slope, 1e-7 * (1 + std::abs(slope)));
        }
        const LobeDirection sample = sample_lobe(lobe, 0.45, 0.8);  // q = 0.6^2 by v alone
        EXPECT_EQ(sample.dln_pdf_du, 0);
        EXPECT_NEAR(sample.dln_pdf_dv, 2.4 * eval_lobe(lobe, 0.36).dln_pdf, 1e-12);
    }
}

// Hard case: the textbook's inversion divides by 2 g. The cosine of Henyey and Greenstein near
// g = 0 is k + g (1 - k^2) 3/2 ... : compared with 1e-9 in extended precision.
TEST(Lobe, HenyeyGreensteinIsSmoothAtIsotropy) {
    for (const double g : {0.0, 1e-12, 1e-9, 1e-6, -1e-9}) {
        for (const double q : {0.1, 0.5, 0.8}) {
            const long double k = 1 - 2 * static_cast<long double>(q), G = g;
            const long double a = 1 + G * k;
            const long double exact =
                1 - (1 - G) * (1 - G) * q * (2 + G + G * k) / (a * a);  // no division by g
            const LobePoint at = eval_lobe({Lobe::Kind::henyey_greenstein, g}, q);
            EXPECT_NEAR(at.cosine, static_cast<double>(exact), 1e-15);
            EXPECT_NEAR(at.dcosine, -2, 1e-5);
        }
    }
    // The same against the textbook's form where that has digits.
    const long double g = 1e-3L, f = (1 - g * g) / (1 - g + 2 * g * 0.7L);
    EXPECT_NEAR(eval_lobe({Lobe::Kind::henyey_greenstein, 1e-3}, 0.3).cosine,
                static_cast<double>((1 + g * g - f * f) / (2 * g)), 1e-15);
}

// Hard case: on the axis the concentric columns have their limits, and area times pdf is 1.
TEST(Lobe, AxisHasALimit) {
    for (const double S : {0.0, 1.0, 40.0, 1e6}) {
        const LobeDirection at = sample_lobe({Lobe::Kind::power, S}, 0.5, 0.5);
        EXPECT_EQ(at.D, glm::dvec3(0, 0, 1));
        const double product =
            glm::length(glm::cross(at.dD_du, at.dD_dv)) * (S + 1) / (2 * std::numbers::pi);
        EXPECT_NEAR(product, 1, 1e-14);
        const LobeDirection near = sample_lobe({Lobe::Kind::power, S}, 0.5 + 1e-9, 0.5);
        EXPECT_LT(glm::length(near.dD_du - at.dD_du), 1e-6 * glm::length(at.dD_du));
    }
}

glm::dvec3 on_disk(const DiskPoint& at, const DiskColumn& by) {
    const glm::dvec2 across(-at.outward.y, at.outward.x);
    return {by.radial * at.outward + by.tangential * across, 0};
}

// Hard case: 0/0 in the middle.
TEST(DiskMap, MiddleHasTheColumns2AndHalfPi) {
    const DiskPoint at = map_to_disk(0.5, 0.5);
    EXPECT_EQ(on_disk(at, at.du), glm::dvec3(2, 0, 0));
    EXPECT_NEAR(on_disk(at, at.dv).y, std::numbers::pi / 2, 1e-16);
    EXPECT_EQ(on_disk(at, at.dv).x, 0);
}

// Hard case: columns jump where |a| = |b|, what they span does not.
TEST(DiskMap, AreaIsContinuousAcrossTheDiagonals) {
    for (const double sign : {1.0, -1.0}) {
        for (const double off : {-1e-9, 0.0, 1e-9}) {
            const DiskPoint at = map_to_disk(0.8 + off, 0.5 + sign * 0.3);
            const glm::dvec3 area = glm::cross(on_disk(at, at.du), on_disk(at, at.dv));
            EXPECT_NEAR(area.z, std::numbers::pi, 1e-12);
        }
    }
}

/// D(m) G1(w) (w.m) / w.z of [Walter2007] over solid angle of m [1/sr].
double seen_density(const glm::dvec3& m, const glm::dvec3& w, const MicrofacetWidths& a) {
    const glm::dvec3 scaled(m.x / a.x, m.y / a.y, m.z), stretched(a.x * w.x, a.y * w.y, w.z);
    const double square = glm::dot(scaled, scaled);
    return 2 * glm::dot(w, m) /
           (std::numbers::pi * a.x * a.y * square * square * (w.z + glm::length(stretched)));
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

TEST(SurfaceShape, TriangleWithoutAreaIsFlat) {
    const glm::dvec3 A(1, 2, 3), along(1e-3, 2e-3, -1e-3);
    const std::array<glm::dvec3, 3> normals{glm::dvec3(0, 0, 1), {0, 0.6, 0.8}, {0.6, 0, 0.8}};
    for (const glm::dvec3& C : {A, A + along, A + 3.0 * along}) {
        const SurfaceShape shape = interpolated_shape({A, A + along, C}, normals, A);
        EXPECT_EQ(shape.dN_dP * along, glm::dvec3(0));
        EXPECT_NEAR(glm::length(shape.N), 1, 1e-15);
    }
    // A needle of a millionth of its length is not.
    const SurfaceShape thin =
        interpolated_shape({A, A + glm::dvec3(1, 0, 0), A + glm::dvec3(0, 1e-6, 0)}, normals, A);
    EXPECT_NEAR(glm::length(thin.dN_dP * glm::dvec3(0, 1e-6, 0)), 0.6, 1e-6);
}

}  // namespace

}  // namespace opaline::bake
