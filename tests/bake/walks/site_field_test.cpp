#include "bake/effects/multiple/walks/site_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace opaline::bake {
namespace {

SurfaceSample make_site(glm::vec3 position, glm::vec3 normal) {
    SurfaceSample site{};
    site.position = position;
    site.normal = site.geometric_normal = normal;
    return site;
}

// Both sides of a sheet of thickness `gap`, 0.1 apart.
std::vector<SurfaceSample> make_sheet(float gap) {
    std::vector<SurfaceSample> sites;
    for (int i = -20; i <= 20; ++i) {
        for (int k = -20; k <= 20; ++k) {
            const auto x = 0.1f * static_cast<float>(i), z = 0.1f * static_cast<float>(k);
            sites.push_back(make_site({x, 0, z}, {0, 1, 0}));
            sites.push_back(make_site({x, -gap, z}, {0, -1, 0}));
        }
    }
    return sites;
}

double weighted(const SiteField& field, std::span<const SurfaceSample> sites, glm::vec3 position,
                glm::vec3 normal, const std::function<double(const SurfaceSample&)>& value) {
    std::vector<SiteWeight> weights;
    field.weigh(position, normal, weights);
    double sum = 0;
    for (const SiteWeight& w : weights) {
        sum += static_cast<double>(w.weight) * value(sites[w.site]);
    }
    return sum;
}

TEST(SiteField, ReproducesLinearFunctionsOfThePlaceAndIgnoresTheOtherSide) {
    const auto sites = make_sheet(0.02f);
    const SiteField field(sites, 0.35f);
    for (const glm::vec3 at : {glm::vec3(0, 0, 0), glm::vec3(0.33f, 0, -0.51f),
                               glm::vec3(1.95f, 0, 2)}) {  // the last one in a corner
        const glm::vec3 up(0, 1, 0);
        EXPECT_NEAR(weighted(field, sites, at, up, [](const SurfaceSample&) { return 1.0; }), 1,
                    1e-5);
        const auto top = [](const SurfaceSample& s) { return s.normal.y > 0 ? 1.0 : 100.0; };
        EXPECT_NEAR(weighted(field, sites, at, up, top), 1, 1e-5);
        const auto slope = [](const SurfaceSample& s) {
            return static_cast<double>(s.position.x - 2 * s.position.z);
        };
        // The ridge leaves a little of the slope out where the sites stand to one side.
        EXPECT_NEAR(weighted(field, sites, at, up, slope), static_cast<double>(at.x - 2 * at.z),
                    at.z > 1 ? 0.02 : 2e-3);
    }
}

// Stripes much narrower than the radius: rows that follow them do so between sites as well.
TEST(SiteField, FollowsTheTintWhereItChangesWithinTheRadius) {
    const auto sites = make_sheet(0.02f);
    const auto stripes = [](float x) { return 0.5f + 0.4f * std::sin(25 * x); };
    std::vector<float> tints;
    for (const SurfaceSample& s : sites) {
        tints.push_back(stripes(s.position.x));
    }
    const SiteField field(sites, 0.35f, tints), plain(sites, 0.35f);
    for (const glm::vec3 at : {glm::vec3(0.03f, 0, 0.02f), glm::vec3(0.33f, 0, -0.51f)}) {
        const auto value = [&](const SurfaceSample& s) {
            return static_cast<double>(2 + 3 * stripes(s.position.x) + 0.5f * s.position.z);
        };
        const auto expected = static_cast<double>(2 + 3 * stripes(at.x) + 0.5f * at.z);
        std::vector<SiteWeight> weights;
        field.weigh(at, {0, 1, 0}, weights, stripes(at.x));
        double sum = 0;
        for (const SiteWeight& w : weights) {
            sum += static_cast<double>(w.weight) * value(sites[w.site]);
        }
        EXPECT_NEAR(sum, expected, 0.1);
        EXPECT_GT(std::abs(weighted(plain, sites, at, {0, 1, 0}, value) - expected), 0.3);
    }
}

TEST(SiteField, FollowsTheNormalOnABall) {
    std::vector<SurfaceSample> sites;
    for (int i = 0; i < 3000; ++i) {
        const double z = 1 - (2 * i + 1) / 3000.0, phi = 2.399963 * i, s = std::sqrt(1 - z * z);
        const glm::vec3 n(s * std::cos(phi), s * std::sin(phi), z);
        sites.push_back(make_site(n, n));
    }
    const SiteField field(sites, 0.3f);
    const glm::vec3 at = glm::normalize(glm::vec3(1, 2, -0.5f));
    const auto cosine = [](const SurfaceSample& s) {
        return static_cast<double>(glm::dot(s.normal, glm::vec3(0.6f, 0, 0.8f)));
    };
    EXPECT_NEAR(weighted(field, sites, at, at, cosine),
                static_cast<double>(glm::dot(at, glm::vec3(0.6f, 0, 0.8f))), 0.01);
}

// A rounded ridge narrower than the radius, such as the rim of a feather: its crest is symmetric,
// so that nothing linear in offsets and coordinates across the normal tells it from its flanks.
TEST(SiteField, TellsTheCrestOfARidgeFromItsFlanks) {
    constexpr float kRidge = 0.15f;
    std::vector<SurfaceSample> sites;
    for (int i = -15; i <= 15; ++i) {
        for (int k = -20; k <= 20; ++k) {
            const float angle = 0.1f * static_cast<float>(i);
            const glm::vec3 n(std::sin(angle), std::cos(angle), 0);
            sites.push_back(
                make_site(kRidge * n + glm::vec3(0, 0, 0.05f * static_cast<float>(k)), n));
        }
    }
    const SiteField field(sites, 0.35f);
    const auto light = [](const SurfaceSample& s) { return static_cast<double>(s.normal.y); };
    for (const float angle : {0.0f, 0.4f, -0.8f}) {
        const glm::vec3 n(std::sin(angle), std::cos(angle), 0);
        EXPECT_NEAR(weighted(field, sites, kRidge * n, n, light), static_cast<double>(n.y), 0.03)
            << angle;
    }
}

TEST(SiteField, FarAwayOrFacingNoSiteTheNearestStandIn) {
    const std::vector<SurfaceSample> one{make_site({0, 0, 0}, {0, 1, 0})};
    const SiteField field(one, 0.1f);
    const auto value = [](const SurfaceSample&) { return 3.0; };
    EXPECT_NEAR(weighted(field, one, {5, 0, 0}, {0, 1, 0}, value), 3, 1e-5);
    EXPECT_NEAR(weighted(field, one, {5, 0, 0}, {0, -1, 0}, value), 3, 1e-5);
    std::vector<SiteWeight> weights;
    SiteField().weigh({0, 0, 0}, {0, 1, 0}, weights);
    EXPECT_TRUE(weights.empty());
}

}  // namespace
}  // namespace opaline::bake
