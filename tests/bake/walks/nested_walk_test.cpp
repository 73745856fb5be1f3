// Walks through bodies that contain other media.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bake/effects/multiple/walks/walk_boundary.h"
#include "bake/physics/fresnel.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/bake/walks/nested_bodies.h"

namespace opaline::tests {
namespace {

/// Not scattering; all three bands alike.
formats::Medium make_clear(float sigma_a, float eta) {
    formats::Medium clear = make_grey_medium(0, sigma_a, eta);
    clear.roughness = 0;  // walks know smooth boundaries, the reference rough ones of clear bodies
    return clear;
}

// A half space under a layer that starts at y = 0: as deep as light of 3 / m with albedo .9 gets,
// and no wider than rounding allows.
std::vector<Part> make_layers(float thickness, const formats::Medium& layer,
                              const formats::Medium& under) {
    constexpr float kDeep = 12, kWide = 100;
    const auto box = [&](float low, float high, float wide) {
        Primitive slab = make_cube(1, false);
        for (glm::vec3& p : slab.position) {
            p = {wide * p.x, p.y > 0 ? high : low, wide * p.z};
        }
        return slab;
    };
    return {{box(-kDeep, 0, kWide), layer}, {box(-kDeep + 0.01f, -thickness, kWide - 0.1f), under}};
}

const glm::vec3 kUp(0, 1, 0);

TEST(NestedWalk, CoreOfTheSameMediumChangesNothing) {
    for (const float eta : {1.0f, 1.4f}) {
        const formats::Medium medium = make_forward_medium(6, 0.9f, 0.4f, eta);
        const auto alone = make_nested_body({{make_sphere(3), medium}});
        const auto both =
            make_nested_body({{make_sphere(3), medium}, {make_sphere(3, 0.7f), medium}});
        EXPECT_EQ(both->space.media.size(), 1u);
        const bake::WalkStart start = start_at(both->space, {0.02f, 2, 0.03f}, -kUp);
        const Leaving one = walk_from(alone->space, start, 1, 20000),
                      two = walk_from(both->space, start, 1, 20000);
        EXPECT_NEAR(two.all, one.all, 4 * std::hypot(one.error, two.error)) << eta;
        EXPECT_NEAR(two.below, one.below, 6 * std::hypot(one.error, two.error)) << eta;
        EXPECT_EQ(two.counts.lost + two.counts.buried, 0u);
    }
}

// A filter that scatters nothing over a half space of isotropic scatterers, all of index 1: of
// uniform light it shows 4 int int e^(-t/m) R(m, m') e^(-t/m') m m' dm dm' with Chandrasekhar's
// R = a/4 H(m) H(m') / (m + m').
TEST(NestedWalk, AbsorbingCoatFiltersLightBothWaysAsChandrasekharsFunctionSays) {
    constexpr float kAlbedo = 0.9f, kThickness = 0.5f;
    const bake::GaussLegendre rule = bake::make_gauss_legendre(64);
    const std::vector<double> h = chandrasekhar_h(static_cast<double>(kAlbedo), rule);
    for (const float sigma_a : {0.0f, 0.4f, 2.0f}) {
        const double depth = static_cast<double>(sigma_a * kThickness);
        double expected = 0;
        for (std::size_t i = 0; i < h.size(); ++i) {
            for (std::size_t j = 0; j < h.size(); ++j) {
                const double m = rule.node[i], n = rule.node[j];
                expected += 4 * rule.weight[i] * rule.weight[j] * std::exp(-depth / m - depth / n) *
                            0.25 * static_cast<double>(kAlbedo) * h[i] * h[j] / (m + n) * m * n;
            }
        }
        const auto slab = make_nested_body(
            make_layers(kThickness, make_clear(sigma_a, 1), make_forward_medium(3, kAlbedo, 0, 1)));
        const Leaving leaving = walk_from(slab->space, start_below({0.3f, 0, 0.7f}, kUp), 1, 60000);
        EXPECT_NEAR(leaving.all, expected, 4 * leaving.error) << sigma_a;
        EXPECT_LT(leaving.error, 0.002);
    }
}

// Even light comes through a clear coat of another index unchanged where nothing is absorbed, and
// none of it stays.
TEST(NestedWalk, FurnaceOfAlbedoOneInEveryMediumLosesNothing) {
    constexpr std::uint32_t kWalks = 20000;
    double sum = 0;
    const auto expect_white = [&](std::vector<Part> parts, const char* what) {
        const auto body = make_nested_body(std::move(parts));
        const Leaving leaving =
            walk_from(body->space, start_at(body->space, {0.02f, 2, 0.03f}, -kUp), 1, kWalks);
        const double all = leaving.all * leaving.counts.correction();
        sum += all;
        // What crosses a matched coat unscattered is 1/2 (sigma_t R)^-2 of the light.
        EXPECT_NEAR(all, 1, 4 * leaving.error + 5e-4) << what;
        EXPECT_LT(leaving.error, 0.0025) << what;
        // Facets may trap light between clear media.
        EXPECT_EQ(leaving.counts.lost + leaving.counts.buried, 0u) << what;
        EXPECT_LT(leaving.counts.endless, kWalks / 200) << what;
    };
    const auto scatters = [](float sigma, float eta) {
        return make_forward_medium(sigma, 1, 0.3f, eta);
    };
    expect_white({{make_sphere(3), scatters(30, 1.5f)}, {make_sphere(3, 0.8f), scatters(9, 1.3f)}},
                 "1.5 over 1.3");
    expect_white({{make_sphere(3), scatters(9, 1.3f)}, {make_sphere(3, 0.8f), scatters(50, 1.5f)}},
                 "1.3 over 1.5");
    expect_white(
        {{make_sphere(3), make_clear(0, 1.5f)}, {make_sphere(3, 0.97f), scatters(60, 1.3f)}},
        "clear coat");
    expect_white({{make_sphere(3), scatters(40, 1)},
                  {make_sphere(3, 0.8f), scatters(30, 1.5f)},
                  {make_sphere(3, 0.5f), make_clear(0, 1)}},
                 "bubble in a core in a matched coat");
    EXPECT_NEAR(sum / 4, 1, 0.002);
}

// What the top of a body shows along its normal under a sky that is bright above, by walks and by
// the Monte Carlo reference, which shares no code with them.
struct Compared {
    std::array<double, 3> walked{}, walked_error{}, truth{}, truth_error{};
};

Compared compare_with_reference(std::vector<Part> parts, std::uint32_t walks,
                                std::uint32_t samples) {
    const bool grey = std::ranges::all_of(parts, [](const Part& part) {
        const formats::Medium& m = part.second;
        return m.sigma_s.r == m.sigma_s.g && m.sigma_s.g == m.sigma_s.b &&
               m.sigma_a.r == m.sigma_a.g && m.sigma_a.g == m.sigma_a.b;
    });
    const auto body = make_nested_body(parts, grey);
    bake::WalkStart start = start_at(body->space, {0.11f, 2, 0.07f}, -kUp);
    start.seen = start.normal;
    const auto eta = static_cast<double>(body->space.eta);
    const double enters = bake::fresnel_transmittance(1, eta);
    Compared result;
    const BandsLeaving leaving = walk_bands(body->space, start, walks,
                                            [](const auto& exit) { return exit.direction.y > 0; });
    EXPECT_EQ(leaving.counts.lost + leaving.counts.endless + leaving.counts.buried, 0u);
    const auto truth = make_fixture(make_nested_scene(std::move(parts)), make_half_sky(true));
    bake::PathOptions scattered;
    scattered.terms = formats::TermSet::single | formats::TermSet::multiple;
    const bake::Moments moments =
        look(truth->space(scattered), start.position + start.normal, -start.normal, samples);
    const glm::dvec3 error = glm::sqrt(moments.variance_of_mean());
    for (int b = 0; b < 3; ++b) {
        const auto at = static_cast<std::size_t>(b);
        result.truth[at] = moments.mean[b];
        result.truth_error[at] = error[b];
        result.walked[at] = enters * leaving.mean[grey ? 0 : at];
        result.walked_error[at] = enters * leaving.error[grey ? 0 : at];
    }
    return result;
}

void expect_agreement(const Compared& compared, const char* what) {
    for (std::size_t b = 0; b < 3; ++b) {
        const double error = std::hypot(compared.walked_error[b], compared.truth_error[b]);
        EXPECT_NEAR(compared.walked[b], compared.truth[b], 4 * error) << what << ", band " << b;
        EXPECT_LT(error, 0.02 * compared.truth[b] + 0.002) << what;
        EXPECT_GT(compared.truth[b], 0.02) << what;
    }
}

TEST(NestedWalk, BallsInBallsShowWhatTheMonteCarloReferenceShows) {
    const auto outer = [](float eta) { return make_forward_medium(4, 0.95f, 0, eta); };
    const auto compare = [](std::vector<Part> parts, const char* what) {
        expect_agreement(compare_with_reference(std::move(parts), 30000, 60000), what);
    };
    compare({{make_sphere(3), outer(1.3f)},
             {make_sphere(3, 0.7f), make_forward_medium(20, 0.99f, 0.5f, 1.5f)}},
            "denser core of a higher index");
    compare({{make_sphere(3), outer(1.5f)},
             {make_sphere(3, 0.8f), make_forward_medium(20, 0.7f, -0.3f, 1.3f)}},
            "darker core of a lower index");
    compare({{make_sphere(3), outer(1.3f)}, {make_sphere(3, 0.7f), make_clear(1e-3f, 1)}},
            "bubble");
    compare({{make_sphere(3), outer(1.3f)}, {make_sphere(3, 0.7f), make_clear(40, 1.3f)}},
            "matched core that absorbs");
    compare({{make_sphere(3), outer(1)},
             {make_sphere(3, 0.7f), make_forward_medium(10, 0.99f, 0.3f, 1)}},
            "all of index 1");
    compare({{make_sphere(3), make_clear(0.5f, 1.5f)},
             {make_sphere(3, 0.9f), make_forward_medium(20, 0.98f, 0.3f, 1.3f)}},
            "tinted glass around a core");
    compare({{make_sphere(3), outer(1.2f)},
             {make_sphere(3, 0.8f), make_forward_medium(8, 0.98f, 0.6f, 1.5f)},
             {make_sphere(2, 0.4f, {0.2f, 0.1f, 0}), make_clear(1, 1)}},
            "three in each other");
}

// Bands in groups that differ from medium to medium; one that is scattered in one medium alone.
TEST(NestedWalk, ColouredMediaInEachOtherShowWhatTheMonteCarloReferenceShowsInEveryBand) {
    formats::Medium coat = make_forward_medium(1, 1, 0, 1.3f),
                    core = make_forward_medium(1, 1, 0.4f, 1.5f);
    coat.sigma_s = {4, 4, 0};
    coat.sigma_a = {0.1f, 0.1f, 0.6f};
    core.sigma_s = {12, 3, 8};
    core.sigma_a = {0.1f, 0.3f, 0.2f};
    const std::vector<Part> parts{{make_sphere(3), coat}, {make_sphere(3, 0.8f), core}};
    EXPECT_EQ(make_nested_body(parts, false)->space.bands.size(), 3u);
    expect_agreement(compare_with_reference(parts, 30000, 200000), "coloured");
}

// Light of three bands that differ in how they are absorbed by clear media alone flies alike.
TEST(NestedWalk, BandsThatClearMediaAbsorbDifferentlyShareTheirWalks) {
    formats::Medium glass = make_clear(1, 1.5f);
    glass.sigma_a = {0.1f, 0.4f, 1.6f};
    const std::vector<Part> parts{{make_sphere(3), glass},
                                  {make_sphere(3, 0.9f), make_forward_medium(20, 0.98f, 0, 1.5f)}};
    EXPECT_EQ(make_nested_body(parts, false)->space.bands.size(), 1u);
}

// Whatever the meshes, walks end and weigh no more than what they started with.
TEST(NestedWalk, TouchingOverlappingOpenAndTurnedBodiesEndAllWalksWithFiniteWeights) {
    const formats::Medium coat = make_forward_medium(3, 0.95f, 0, 1.3f),
                          core = make_forward_medium(9, 0.98f, 0.4f, 1.6f);
    Primitive open = make_sphere(3, 0.8f);
    open.index.resize(open.index.size() / 2);
    const auto counts_of = [](std::vector<Part> parts, const char* what) {
        const auto body = make_nested_body(std::move(parts));
        bake::WalkCounts counts;
        for (const glm::vec3 along : {glm::vec3(0, -1, 0), {0.8f, 0, 0.6f}, {-0.6f, 0.8f, 0}}) {
            const bake::WalkStart start =
                start_at(body->space, -3.0f * along + glm::vec3(0.01f, 0.02f, 0.03f), along);
            counts += visit_walks(body->space, start, {1}, 1500, [&](const auto& exits) {
                float sum = 0;
                for (const bake::WalkExit& exit : exits) {
                    sum += exit.weight[0];
                    EXPECT_NEAR(glm::length(exit.direction), 1, 1e-3f) << what;
                }
                EXPECT_TRUE(sum >= 0 && sum < 6) << what << " " << sum;
            });
        }
        EXPECT_LE(counts.unfinished(), static_cast<double>(counts.walks) + 1) << what;
        return counts;
    };
    counts_of({{make_sphere(3), coat}, {make_sphere(3), core}}, "in one place");
    counts_of({{make_sphere(3), coat}, {make_sphere(3, 0.5f, {0.5f, 0, 0}), core}}, "touching");
    counts_of({{make_sphere(3), coat}, {make_sphere(3, 0.5f, {0.8f, 0, 0}), core}}, "half outside");
    counts_of({{make_sphere(3), coat},
               {make_sphere(3, 0.5f, {0.2f, 0, 0}), core},
               {make_sphere(3, 0.5f, {-0.2f, 0, 0}), make_clear(0.1f, 1)}},
              "overlapping cores");
    counts_of({{make_sphere(3), coat}, {turned_inside_out(make_sphere(3, 0.7f)), core}}, "turned");
    EXPECT_GT(counts_of({{make_sphere(3), coat}, {open, core}}, "open").lost, 0u);
    EXPECT_GT(counts_of({{make_sphere(3), coat}, {open, make_clear(0, 1.6f)}}, "open, clear").lost,
              0u);
}

TEST(NestedWalk, FortyBodiesInEachOtherAreFollowedWhereTheirMediaAlternateFewTimes) {
    const auto nest = [](const auto& medium_of) {
        std::vector<Part> parts;
        parts.reserve(40);
        for (int i = 0; i < 40; ++i) {
            parts.push_back({make_sphere(2, 1 - 0.02f * static_cast<float>(i)), medium_of(i)});
        }
        const auto body = make_nested_body(std::move(parts));
        return walk_from(body->space, start_at(body->space, {0.02f, 2, 0.03f}, -kUp), 1, 1000);
    };
    // Matched, so that all that differs is how they are counted.
    const Leaving alike = nest([](int) { return make_forward_medium(20, 1, 0, 1.3f); });
    EXPECT_EQ(alike.counts.buried, 0u);
    EXPECT_NEAR(alike.all, 1, 4 * alike.error + 0.005);
    const Leaving striped =
        nest([](int i) { return make_forward_medium(i % 2 == 0 ? 20.0f : 3.0f, 1, 0, 1.3f); });
    EXPECT_GT(striped.counts.buried, 0u);
    EXPECT_LT(striped.all, 1);
    EXPECT_NEAR(striped.all * striped.counts.correction(), 1, 0.05);
}

// The floor of a body, met from above and from below.
TEST(NestedWalk, ThingsInsideReflectTheirColourFromTheSideThatIsSeen) {
    Primitive floor = make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    floor.material = 1;
    Scene scene = make_translucent_scene({make_sphere(3, 3), floor}, make_grey_medium(1, 0, 1.3f));
    formats::Material& thing = scene.materials[1];
    thing.base_color = {0.9f, 0.6f, 0.3f};
    const auto reflect = [&](bool grey, float toward, float u) {
        const auto body = make_walked_scene(scene, grey);
        bake::WalkHit hit;
        const glm::vec3 from(0.1f, -toward, 0.2f), along(0, toward, 0);
        EXPECT_TRUE(bake::find_hit(body->space, from, along, 5, hit));
        return bake::reflect_at(body->space, hit, along, u);
    };
    const auto seen = reflect(false, -1, 0.5f);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->normal, kUp);
    EXPECT_EQ(seen->albedo, (std::array{0.9f, 0.6f, 0.3f}));
    EXPECT_FALSE(reflect(false, 1, 0.5f)) << "black from behind";
    const auto grey = reflect(true, -1, 0.5f);
    ASSERT_TRUE(grey);
    EXPECT_NEAR(grey->albedo[2], 0.6f, 1e-6f);
    thing.double_sided = true;
    EXPECT_EQ(reflect(false, 1, 0.5f)->normal, -kUp);
    // Of a leaf that reflects .2 and transmits .6 each way stands for all light that leaves it.
    thing.base_color = {1, 1, 1};
    thing.sheet = formats::Sheet{{0.2f, 0.2f, 0.2f}, {0.6f, 0.6f, 0.6f}};
    const auto back = reflect(false, -1, 0.2f), through = reflect(false, -1, 0.3f);
    EXPECT_EQ(back->normal, kUp);
    EXPECT_EQ(through->normal, -kUp);
    EXPECT_NEAR(back->albedo[0], 0.8f, 1e-6f);
    EXPECT_NEAR(through->albedo[0], 0.8f, 1e-6f);
}

}  // namespace
}  // namespace opaline::tests
