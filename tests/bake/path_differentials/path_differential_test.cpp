#include "bake/physics/path_differentials/path_differential.h"

#include <numbers>

#include "bake/physics/path_differentials/axis_frame.h"
#include "tests/bake/path_differentials/event_check.h"
#include "tests/bake/path_differentials/path_rules.h"

namespace opaline::bake {
namespace {

using tests::kStill;
using tests::kUp;
using tests::unlimited_rules;

// The chain of the table by the path's own events, against dual numbers through all of it.
TEST(PathDifferential, FollowsTheEventsOfItsPath) {
    const tests::GlossyChain chain;
    const auto [x, y, u, v] = chain.x;
    const DifferentialRules rules = unlimited_rules(1e16);  // steps of 1e-4 of four numbers
    const glm::dvec3 view(x, y, -1), D = glm::normalize(view);
    PathDifferential path;
    for (const glm::dvec3& side : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) {
        add_variable(path, {kStill, (side - D * glm::dot(D, side)) / glm::length(view), 0, 1});
    }
    const double t = tests::sphere_distance<double>(chain.eye, D, chain.center, 1);
    const glm::dvec3 on_sphere = chain.eye + t * D, N = on_sphere - chain.center;
    move_to_surface(path, D, N, t);
    const Mirror mirror = make_mirror(D, N);
    reflect_columns(path, mirror, glm::dmat3(1.0));
    const glm::dvec3 out = scatter_in_lobe(
        path, rules, {mirror.reflected, {Lobe::Kind::power, chain.exponent}, u, v, N});
    for (DifferentialColumn& column : path.columns()) {
        column.dlnW += (glm::dot(column.dP, out) + glm::dot(N, column.dD)) / glm::dot(N, out);
    }
    const double down = tests::plane_distance<double>(on_sphere, out, kUp, chain.floor);
    move_to_surface(path, out, kUp, down);
    ASSERT_EQ(path.count, 4u);
    EXPECT_EQ(path.variables, 4);
    for (std::size_t i = 0; i < 4; ++i) {
        std::array<tests::Dual, 4> moving{x, y, u, v};
        moving[i].change = 1;
        const auto exact = trace_chain(chain, moving, mirror.reflected);
        const DifferentialColumn& column = path.column[i];
        EXPECT_LT(glm::length(column.dP - changes(exact.P)), 1e-7 * 40) << i;
        EXPECT_NEAR(column.dlnW, exact.lnW.change, 1e-7) << i;
    }
    // Numbers of the table.
    EXPECT_NEAR(path.column[0].dP.x, 17.63656291028699, 1e-6);
    EXPECT_NEAR(path.column[1].dP.z, 37.218610504426096, 1e-6);
    EXPECT_NEAR((on_sphere + down * out).z, 2.813336713807311, 1e-13);
}

// Numbers of the literature; a step never exceeds the domain.
TEST(PathDifferential, GlobalStepsAreThoseOfTheLiterature) {
    EXPECT_NEAR(global_step(400000, 4, 1), 0.0398, 5e-5);
    EXPECT_NEAR(global_step(400000, 6, 1), 0.1165, 5e-5);
    EXPECT_NEAR(global_step(400000, 8, 1), 0.1994, 5e-5);
    EXPECT_NEAR(global_step(400000, 6, 0.25), 0.1468, 5e-5);
    EXPECT_EQ(global_step(10, 4, 0.01), 1);
    EXPECT_EQ(global_step(10, 0, 1), 1);
}

TEST(PathDifferential, GlobalStepsShrinkForOlderVariablesToo) {
    const DifferentialRules rules = unlimited_rules(400000);
    PathDifferential path;
    for (int i = 0; i < 4; ++i) {
        add_variable(path, {});
    }
    EXPECT_NEAR(column_step(path, rules, path.column[0]), global_step(400000, 4, 1), 1e-15);
    path.survival = 0.25;
    scatter_in_lobe(path, rules, {.N_g = glm::dvec3(0, 0, 1)});
    EXPECT_NEAR(column_step(path, rules, path.column[0]), 0.1468, 5e-5);
    EXPECT_EQ(column_step(path, rules, path.column[0]), column_step(path, rules, path.column[5]));
}

TEST(PathDifferential, LimitHoldsFromTheSecondScattering) {
    DifferentialRules rules;
    PathDifferential path;
    add_variable(path, {kStill, kStill, -7, 0.5});
    EXPECT_EQ(column_step(path, rules, path.column[0]), 0.5);
    path.scatterings = 1;
    EXPECT_EQ(column_step(path, rules, path.column[0]), 0.5);
    path.scatterings = 2;
    EXPECT_DOUBLE_EQ(column_step(path, rules, path.column[0]), 0.1);
}

// The lobe of an older variable turns with its axis, so its factor does not change.
TEST(PathDifferential, OlderVariablesKeepTheAngleToTheAxis) {
    tests::RandomInputs random(39);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 R = random.unit();
        PathDifferential path;
        const glm::dvec3 dR = random.change_of(R);
        add_variable(path, {kStill, dR, 0, 1});
        const glm::dvec3 D = scatter_in_lobe(path, unlimited_rules(),
                                             {.axis = R,
                                              .lobe = {Lobe::Kind::power, 20},
                                              .u = random.uniform(),
                                              .v = random.uniform(),
                                              .N_g = R});
        EXPECT_NEAR(glm::dot(dR, D) + glm::dot(R, path.column[0].dD), 0, 1e-12);
        EXPECT_EQ(path.column[0].dlnW, 0);
    }
}

// Four columns of a diffuse light: two of position, two of direction, which span area times pi.
TEST(PathDifferential, LightStartsWithFourColumns) {
    const std::array<glm::dvec3, 3> corners{glm::dvec3(0, 0, 0), {2, 0, 0}, {0, 0, 1}};
    const AreaSample light = sample_triangle_folded(corners, 0.3, 0.6);
    PathDifferential path;
    add_variable(path, {light.dP_du, kStill, 0, 1});
    add_variable(path, {light.dP_dv, kStill, 0, 1});
    aim_at_normal(path, glm::dmat3(0.0));
    const DifferentialRules rules = unlimited_rules(1e12);  // small steps: secants are derivatives
    const glm::dvec3 D =
        scatter_in_lobe(path, rules, {.axis = kUp, .u = 0.8, .v = 0.4, .N_g = kUp});
    ASSERT_EQ(path.count, 4u);
    EXPECT_EQ(path.column[0].dD, kStill);
    const double position = glm::length(glm::cross(path.column[0].dP, path.column[1].dP));
    const double direction = glm::length(glm::cross(path.column[2].dD, path.column[3].dD));
    EXPECT_NEAR(position, 1, 1e-14);
    EXPECT_NEAR(direction, std::numbers::pi / D.y, 1e-4);
}

// Reflected or refracted by facets on a flat surface, by dual numbers through the whole event.
TEST(PathDifferential, FacetsOfAFlatSurfaceAreDerivatives) {
    tests::RandomInputs random(40);
    for (const double eta : {0.0, 0.7}) {
        tests::ColumnErrors errors;
        int sampled = 0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 N = random.unit(), D = -random.unit_facing(N, 0.3);
            const glm::dvec3 dD = random.change_of(D);
            const FacetEvent event{.D = D,
                                   .N = N,
                                   .alpha = 0.3,
                                   .eta = eta,
                                   .u = random.uniform(0.2, 0.45),
                                   .v = random.uniform(0.6, 0.7),
                                   .N_g = N};
            PathDifferential path;
            add_variable(path, {kStill, dD, 0, 1e-6});
            const auto out = scatter_on_facets(path, unlimited_rules(), event);
            if (!out) continue;
            ++sampled;
            const glm::dmat3 frame = frame_around(N);
            const auto direction = [&](auto x) {
                using S = decltype(x);
                using Axes = tests::Vector<S>;
                const Axes d = tests::moved(D, dD, x);
                const auto local = [&](const glm::dvec3& axis) {
                    return tests::dot(Axes(axis), d);
                };
                const Axes in{local(frame[0]), local(frame[1]), local(frame[2])};
                const Axes m = tests::visible_normal<S>(
                    S(-1) * in, 0.3, 0.3, tests::concentric_point<S>(S(event.u), S(event.v)));
                const Axes w =
                    eta > 0 ? tests::refracted<S>(in, m, S(eta)) : tests::mirrored<S>(in, m);
                return tests::in_frame<S>({Axes(frame[0]), Axes(frame[1])}, Axes(N), w);
            };
            errors.add(direction, path.column[0].dD);
            EXPECT_LT(glm::length(*out - values(direction(0.0))), 1e-12);
        }
        EXPECT_GT(sampled, 1000);
        tests::expect_derivatives(errors, 1e-7, 1e-6);
    }
}

// If the ray and the surface turn as one, so does what is reflected.
TEST(PathDifferential, FacetsTurnWithTheirSurface) {
    tests::RandomInputs random(41);
    for (const double eta : {0.0, 0.7}) {
        for (int i = 0; i < 1000; ++i) {
            const glm::dvec3 N = random.unit(), D = -random.unit_facing(N, 0.3);
            const glm::dvec3 dP = random.change_of(N);
            // The sphere of radius 1: dN = dP, and the turn is N x dN.
            const glm::dvec3 turn = glm::cross(N, dP);
            PathDifferential path;
            add_variable(path, {dP, glm::cross(turn, D), 0, 1e-6});
            const auto out = scatter_on_facets(path, unlimited_rules(),
                                               {.D = D,
                                                .N = N,
                                                .dN_dP = glm::dmat3(1.0),
                                                .alpha = 0.3,
                                                .eta = eta,
                                                .u = random.uniform(),
                                                .v = random.uniform(),
                                                .N_g = N});
            if (out) {
                EXPECT_LT(glm::length(path.column[0].dD - glm::cross(turn, *out)), 1e-10);
                EXPECT_LT(std::abs(glm::dot(path.column[1].dD, *out)),
                          1e-10 * (1 + glm::length(path.column[1].dD)));
            }
        }
    }
}

// Hard case: 0 / 0 where the contribution is 0. The path ends before it is asked for a footprint.
TEST(PathDifferential, WithoutContributionEnds) {
    // Some facets that are seen from near the horizon reflect to below it.
    tests::RandomInputs random(44);
    int ended = 0;
    for (int i = 0; i < 1000; ++i) {
        PathDifferential facet;
        const auto out = scatter_on_facets(facet, unlimited_rules(),
                                           {.D = {std::sqrt(1 - 0.05 * 0.05), 0, -0.05},
                                            .alpha = 1,
                                            .u = random.uniform(),
                                            .v = random.uniform()});
        ended += out ? 0 : 1;
        EXPECT_EQ(facet.count, out ? 2u : 0u);
    }
    EXPECT_GT(ended, 0);
}

// Hard case: beyond the critical angle the event is a mirror.
TEST(PathDifferential, TotalReflectionHasTheColumnsOfAMirror) {
    const glm::dvec3 D = glm::normalize(glm::dvec3(0.9, -0.3, 0)), dD(0, 0, 1);
    ASSERT_FALSE(make_refraction(D, kUp, 1.5));
    PathDifferential path;
    add_variable(path, {kStill, dD, 0, 1});
    reflect_columns(path, make_mirror(D, kUp), glm::dmat3(0.0));
    EXPECT_EQ(path.column[0].dD, dD);
    // From the denser side a rough surface's facets do it too.
    PathDifferential rough;
    EXPECT_FALSE(scatter_on_facets(rough, unlimited_rules(),
                                   {.D = D, .N = kUp, .alpha = 1e-3, .eta = 1.5, .N_g = kUp}));
}

TEST(PathDifferential, RefractionIsTheEventOfEachColumn) {
    const glm::dvec3 D = glm::normalize(glm::dvec3(0.4, -1, 0)), dD(0, 0, 1e-3);
    const auto event = make_refraction(D, kUp, 1 / 1.5);
    ASSERT_TRUE(event);
    PathDifferential path;
    add_variable(path, {{0.1, 0, 0}, dD, 0, 1e-3});
    refract_columns(path, unlimited_rules(), *event, glm::dmat3(0.5));
    const glm::dvec3 exact = event->change(dD, {0.05, 0, 0});
    EXPECT_LT(glm::length(path.column[0].dD - exact), 1e-8);
}

}  // namespace
}  // namespace opaline::bake
