#include "bake/exchange/gather_sites.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "bake/base/rng.h"

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

}  // namespace
}  // namespace opaline::bake
