#include "bake/path_differentials/path_differential.h"

#include <numbers>

#include "bake/path_differentials/area_sample.h"
#include "bake/path_differentials/steps.h"
#include "bake/path_differentials/surface_shape.h"
#include "tests/bake/path_differentials/event_check.h"
#include "tests/bake/path_differentials/path_rules.h"

namespace opaline::bake {
namespace {

using tests::global_rules;
using tests::kChain;
using tests::kPoint;
using tests::kStill;
using tests::kUp;
using tests::local_rules;

/// The chain of the table by the path's own events: eye, glossy sphere, floor.
struct FollowedChain {
    PathDifferential path;
    glm::dvec3 at{0};
};

FollowedChain follow(const tests::GlossyChain& chain, const tests::ChainPoint& x, double step,
                     const DifferentialRules& rules) {
    const CameraStart start =
        start_at_pinhole({chain.eye, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}}, x.x, x.y);
    FollowedChain out;
    PathDifferential& path = out.path;
    add_variable(path, {kStill, start.dD_dx, 0, step});
    add_variable(path, {kStill, start.dD_dy, 0, step});
    const double t = tests::sphere_distance<double>(start.P, start.D, chain.center, chain.radius);
    const glm::dvec3 on_sphere = start.P + t * start.D;
    const SurfaceShape sphere = sphere_shape(chain.center, chain.radius, on_sphere);
    move_to_surface(path, start.D, sphere.N, t);
    const Mirror mirror = make_mirror(start.D, sphere.N);
    reflect_columns(path, mirror, sphere.dN_dP);
    const glm::dvec3 D = scatter_in_lobe(path, rules,
                                         {mirror.reflected,
                                          {Lobe::Kind::power, chain.exponent},
                                          DiskMap::polar,
                                          x.u,
                                          x.v,
                                          step,
                                          step,
                                          sphere.N});
    for (DifferentialColumn& column : path.columns()) {
        column.dlnW += dln_cosine(sphere.N, D, sphere.dN_dP * column.dP, column.dD);
    }
    const double down =
        tests::plane_distance<double>(on_sphere, D, kUp, glm::dvec3(0, chain.floor, 0));
    move_to_surface(path, D, kUp, down);
    out.at = on_sphere + down * D;
    return out;
}

TEST(PathDifferential, FollowsTheEventsOfItsPath) {
    const FollowedChain followed = follow(kChain, kPoint, 1e-4, local_rules());
    const tests::NamedValues raw = tests::chain_outputs(kChain, kPoint);
    ASSERT_EQ(followed.path.count, 4u);
    EXPECT_EQ(followed.path.variables, 4);
    const std::array<std::string, 4> names{"x", "y", "u", "v"};
    for (std::size_t i = 0; i < 4; ++i) {
        const DifferentialColumn& column = followed.path.column[i];
        const std::vector<double>& dP = raw.at("dP2_" + names[i]);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(column.dP[k], dP[static_cast<std::size_t>(k)], 1e-7 * 40) << names[i];
        }
        EXPECT_NEAR(column.dlnW, raw.at("dlnW_" + names[i])[0], 1e-7) << names[i];
    }
    // Numbers of the table themselves, so that the project tests itself without it.
    EXPECT_NEAR(followed.path.column[0].dP.x, 17.63656291028699, 1e-6);
    EXPECT_NEAR(followed.path.column[1].dP.z, 37.218610504426096, 1e-6);
    EXPECT_NEAR(followed.at.z, 2.813336713807311, 1e-13);
    EXPECT_NEAR(followed.path.column[3].dlnW, -1.6984961447265563, 1e-7);
}

TEST(PathDifferential, GlobalStepsShrinkForOlderVariablesToo) {
    const DifferentialRules rules = global_rules(400000);
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
    DifferentialRules rules = local_rules();
    rules.gradient_limit = 0.7;
    PathDifferential path;
    add_variable(path, {kStill, kStill, -7, 0.5});
    EXPECT_EQ(column_step(path, rules, path.column[0]), 0.5);
    path.scatterings = 1;
    EXPECT_EQ(column_step(path, rules, path.column[0]), 0.5);
    path.scatterings = 2;
    EXPECT_DOUBLE_EQ(column_step(path, rules, path.column[0]), 0.1);
}

// F and F / p: of a lobe that is sampled exactly, F / p does not change with its own numbers.
TEST(PathDifferential, GradientOfTheWeightLeavesSampledFactorsOut) {
    DifferentialRules rules = local_rules();
    LobeEvent event{.axis = {0, 0, 1},
                    .lobe = {Lobe::Kind::power, 40},
                    .map = DiskMap::polar,
                    .u = 0.2,
                    .v = 0.6,
                    .N_g = glm::dvec3(0, 0, 1)};
    PathDifferential path;
    scatter_in_lobe(path, rules, event);
    EXPECT_EQ(path.column[0].dlnW, 0);
    EXPECT_NEAR(path.column[1].dlnW, -40 / (41 * 0.4), 1e-12);  // -S / ((S + 1) (1 - v))
    rules.form = GradientForm::weight;
    PathDifferential other;
    scatter_in_lobe(other, rules, event);
    EXPECT_EQ(other.column[1].dlnW, 0);
}

// The lobe of an older variable turns with its axis, so its factor does not change.
TEST(PathDifferential, OlderVariablesKeepTheAngleToTheAxis) {
    tests::RandomInputs random(39);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 R = random.unit();
        PathDifferential path;
        const glm::dvec3 dR = random.change_of(R);
        add_variable(path, {kStill, dR, 0, 1});
        const glm::dvec3 D = scatter_in_lobe(path, local_rules(),
                                             {.axis = R,
                                              .lobe = {Lobe::Kind::power, 20},
                                              .u = random.uniform(),
                                              .v = random.uniform(),
                                              .N_g = R});
        EXPECT_NEAR(dln_power(R, D, 20, dR, path.column[0].dD), 0, 1e-11);
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
    const DifferentialRules rules = global_rules(1e12);  // small steps: secants are derivatives
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
            FacetEvent event{.D = D,
                             .N = N,
                             .alpha = 0.3,
                             .eta = eta,
                             .u = random.uniform(0.2, 0.45),
                             .v = random.uniform(0.6, 0.7),
                             .N_g = N};
            PathDifferential path;
            add_variable(path, {kStill, dD, 0, 1e-6});
            event.step_u = event.step_v = 1e-6;
            const auto out = scatter_on_facets(path, local_rules(), event);
            if (!out) {
                continue;
            }
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
            const auto out = scatter_on_facets(path, local_rules(),
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
        const auto out = scatter_on_facets(facet, local_rules(),
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
    EXPECT_FALSE(scatter_on_facets(rough, local_rules(),
                                   {.D = D, .N = kUp, .alpha = 1e-3, .eta = 1.5, .N_g = kUp}));
}

TEST(PathDifferential, RefractionIsTheEventOfEachColumn) {
    const glm::dvec3 D = glm::normalize(glm::dvec3(0.4, -1, 0)), dD(0, 0, 1e-3);
    const auto event = make_refraction(D, kUp, 1 / 1.5);
    ASSERT_TRUE(event);
    PathDifferential path;
    add_variable(path, {{0.1, 0, 0}, dD, 0, 1e-3});
    refract_columns(path, local_rules(), *event, glm::dmat3(0.5));
    const glm::dvec3 exact = event->change(dD, {0.05, 0, 0});
    EXPECT_LT(glm::length(path.column[0].dD - exact), 1e-8);
}

}  // namespace
}  // namespace opaline::bake
