#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "bake/base/rng.h"
#include "bake/effects/interreflection/interreflection.h"
#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/gather_sites.h"
#include "bake/exchange/site_light.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/bake/exchange/bounce_support.h"

namespace opaline::bake {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

// Sites at random places of the unit square of height 0, all of a normal that leans as y grows.
std::vector<GatherSite> make_sites(std::uint32_t count, float clearance, float lean = 0) {
    std::vector<GatherSite> sites;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto u = random_uniform(5, RandomStage::surface_probes, i);
        const float angle = lean * u[1];
        sites.push_back({{{u[0], 0, u[1]}, {0, std::cos(angle), std::sin(angle)}}, clearance});
    }
    return sites;
}

double answer(std::span<const GatherSite> sites, std::span<const SiteWeight> weights,
              auto&& light) {
    double sum = 0;
    for (const SiteWeight& w : weights) {
        sum += static_cast<double>(w.weight) * light(sites[w.site].at);
    }
    return sum;
}

// The ridge of the fit leaves a little of a slope.
TEST(GatherSites, LightThatIsLinearInPlaceIsExactBetweenSites) {
    const std::vector<GatherSite> known = make_sites(400, kFar);
    const GatherSites sites(known);
    std::vector<SiteWeight> weights;
    for (std::uint32_t i = 0; i < 50; ++i) {
        const auto u = random_uniform(6, RandomStage::surface_probes, i);
        const Receiver at{{0.1f + 0.8f * u[0], 0, 0.1f + 0.8f * u[1]}, {0, 1, 0}};
        ASSERT_TRUE(sites.weigh(at, 1, weights));
        EXPECT_NEAR(answer(known, weights, [](const Receiver&) { return 1.0; }), 1, 1e-5);
        const auto slope = [](const Receiver& r) {
            return static_cast<double>(r.origin.x - 2 * r.origin.z);
        };
        EXPECT_NEAR(answer(known, weights, slope), slope(at), 0.01);
    }
}

TEST(GatherSites, LightThatFollowsTheNormalIsThatOfTheNormal) {
    const std::vector<GatherSite> known = make_sites(400, kFar, 1);
    const GatherSites sites(known);
    std::vector<SiteWeight> weights;
    const auto light = [](const Receiver& r) { return static_cast<double>(1 + r.normal.z); };
    for (const float z : {0.2f, 0.5f, 0.8f}) {
        const Receiver at{{0.5f, 0, z}, {0, std::cos(z), std::sin(z)}};
        ASSERT_TRUE(sites.weigh(at, 1, weights));
        EXPECT_NEAR(answer(known, weights, light), light(at), 0.02);
    }
}

// At an edge of a box as many sites face up as to the side.
TEST(GatherSites, SitesThatFaceAnotherWaySayNothing) {
    std::vector<GatherSite> both = make_sites(200, kFar);
    for (const GatherSite& site : make_sites(200, kFar)) {
        both.push_back({{{site.at.origin.x, 0, site.at.origin.z}, {0, 0, 1}}, kFar});
    }
    const GatherSites sites(both);
    std::vector<SiteWeight> weights;
    ASSERT_TRUE(sites.weigh({{0.5f, 0, 0.5f}, {0, 1, 0}}, 1, weights));
    for (const SiteWeight& w : weights) {
        EXPECT_LT(w.site, 200u);
    }
    EXPECT_FALSE(sites.weigh({{0.5f, 0, 0.5f}, {0, -1, 0}}, 1, weights));
    EXPECT_TRUE(weights.empty());
}

TEST(GatherSites, SitesAsFarAsOtherSurfacesSayNothing) {
    std::vector<SiteWeight> weights;
    const Receiver at{{0.5f, 0, 0.5f}, {0, 1, 0}};
    // 32 of 400 sites lie in a circle of radius 0.16.
    EXPECT_TRUE(GatherSites(make_sites(400, 2)).weigh(at, 1, weights));
    EXPECT_FALSE(GatherSites(make_sites(400, 0.2f)).weigh(at, 1, weights));
}

TEST(GatherSites, AnAnswerIsNoNoisierThanAskedFor) {
    const GatherSites sites(make_sites(400, kFar));
    std::vector<SiteWeight> weights;
    int refused = 0;
    for (std::uint32_t i = 0; i < 100; ++i) {
        const auto u = random_uniform(8, RandomStage::surface_probes, i);
        const Receiver at{{u[0], 0, u[1]}, {0, 1, 0}};
        if (!sites.weigh(at, 0.15f, weights)) {
            ++refused;
            continue;
        }
        float noise = 0;
        for (const SiteWeight& w : weights) {
            noise += w.weight * w.weight;
        }
        EXPECT_LE(noise, 0.15f);
    }
    EXPECT_GT(refused, 0) << "at corners of the square";
    EXPECT_LT(refused, 60);
}

TEST(GatherSites, TooFewSitesSayNothing) {
    std::vector<SiteWeight> weights;
    EXPECT_FALSE(GatherSites().weigh({{0, 0, 0}, {0, 1, 0}}, 1, weights));
    EXPECT_FALSE(GatherSites(make_sites(3, kFar)).weigh({{0, 0, 0}, {0, 1, 0}}, 1, weights));
}

// A room open to the front, walls of cells x cells squares.
formats::Scene make_open_room(std::uint32_t cells = 32) {
    using tests::make_quad;
    formats::Scene room = tests::make_scene({
        make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, cells),  // floor
        make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, cells),  // ceiling
        make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells),  // back
        make_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, cells),  // left
        make_quad({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, cells),  // right
    });
    room.materials[0].base_color = {0.7f, 0.7f, 0.7f};
    return room;
}

// A scene and the light between its surfaces.
struct LitWorld : tests::LitScene {
    LitWorld(formats::Scene made, double bounce_rays) : LitScene(std::move(made)) {
        BakeOptions options;
        options.set(kBounceRays, bounce_rays);
        options.effects = {"direct", "interreflection"};
        std::uint64_t traced = 0;
        const Knobs knobs = resolve_knobs(options).value();
        const LightInputs asked{bake, knobs, {}, rows, {}, count_bounce_rays(knobs[kBounceRays])};
        light = solve_exchange(asked, place_exchange(asked, traced), {}, traced);
    }

    std::vector<RowLayout> rows = layouts();
    BakeInputs bake = inputs();
    std::shared_ptr<const BounceLight> light;
};

// Most points of a room need no rays of their own. Row by row, against very many rays.
TEST(SiteLight, PointsBetweenSitesHaveTheLightOfManyRays) {
    const LitWorld world(make_open_room(), 64);
    const auto& light = world.light;
    const auto& receivers = world.receivers;
    ASSERT_NE(light, nullptr);
    const std::size_t size = light->tree.row_size();
    const BounceGrid many = make_bounce_grid(4096);
    double of_sites = 0, of_rays = 0;
    std::size_t without = 0, all = 0;
    for (std::size_t i = 3; i < receivers.size(); i += 53, ++all) {
        std::vector<float> read(size), traced(size), truth(size);
        if (add_bounced(*light, {receivers[i]}, light->cubemap_size, read) > 0) {
            continue;
        }
        ++without;
        std::vector<NodeWeight> weights;
        const auto gather = [&](const BounceGrid& grid, std::uint64_t seed, std::span<float> row) {
            weigh_bounces({world.scene, world.rays}, light->tree, receivers[i], grid, seed,
                          weights);
            add_node_rows(light->tree, weights, row);
        };
        gather(many, 1, truth);
        gather(light->of_receiver, 2, traced);
        for (std::size_t k = 0; k < size; ++k) {
            of_sites += std::pow(static_cast<double>(read[k] - truth[k]), 2);
            of_rays += std::pow(static_cast<double>(traced[k] - truth[k]), 2);
        }
    }
    EXPECT_GT(2 * without, all);
    // 1.3 times as much: a site's 16 stratified rays have more than four times the variance of 64.
    EXPECT_LT(of_sites, 2 * of_rays) << "a fit to sites is worth nearly as much as 64 rays";
}

// Near corners light changes within a fifth of the distance to the next wall: sites follow.
TEST(SiteLight, SitesAreDenserWhereSurfacesAreNear) {
    const LitWorld world(make_open_room(120), 16);
    ASSERT_NE(world.light, nullptr);
    EXPECT_GT(world.light->site_rows.count(), kMostSites + 2000);
    EXPECT_LT(world.light->site_rows.count(), world.receivers.size());
    std::vector<SiteWeight> weights;
    std::size_t without = 0, all = 0;
    for (std::size_t i = 0; i < world.receivers.size(); i += 13, ++all) {
        without += world.light->sites.weigh(world.receivers[i], 0.25f, weights) ? 0 : 1;
    }
    EXPECT_LT(static_cast<double>(without), 0.15 * static_cast<double>(all)) << without;
}

// Shares of the sky and of others add up to 1 at every scatterer, so white surfaces under a sky of
// radiance 1 all have its radiosity, after any number of bounces.
TEST(BounceLight, OfWhiteSurfacesIsThatOfTheSkyAtEveryScatterer) {
    formats::Scene room = make_open_room();
    room.materials[0].base_color = {1, 1, 1};
    const LitWorld world(std::move(room), 16);
    ASSERT_NE(world.light, nullptr);
    const std::vector<double> face = formats::texel_solid_angles(kBounceCubemap);
    std::vector<float> even(std::size_t{6} * face.size());
    for (std::size_t t = 0; t < even.size(); ++t) {
        even[t] = static_cast<float>(face[t % face.size()]);
    }
    formats::haar_forward_cube(std::span<float>(even), kBounceCubemap);
    const BounceTree& tree = world.light->tree;
    for (std::size_t node = 0; node < tree.size(); ++node) {
        const std::vector<float> row = tree.rows().row(node);
        double sum = 0;
        for (std::size_t k = 0; k < even.size(); ++k) {
            sum += static_cast<double>(row[k]) * static_cast<double>(even[k]);
        }
        EXPECT_NEAR(sum / std::numbers::pi, 1, 0.01) << node;
    }
}

// Vertices that seams double trace the same rays: a second site there would pass for another one.
TEST(SiteLight, CopiesOfAVertexAreOneSite) {
    formats::Scene doubled = make_open_room();
    const std::size_t walls = doubled.primitives.size();
    for (std::size_t i = 0; i < walls; ++i) {
        doubled.primitives.push_back(doubled.primitives[i]);
    }
    const auto sites_of = [&](formats::Scene scene) {
        const LitWorld world(std::move(scene), 16);
        return world.light->site_rows.count();
    };
    EXPECT_EQ(sites_of(make_open_room()), 5u * 33 * 33);
    EXPECT_EQ(sites_of(doubled), 5u * 33 * 33);
}

}  // namespace

}  // namespace opaline::bake
