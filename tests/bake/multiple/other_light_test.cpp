#include "bake/transport/other_light.h"

#include <gtest/gtest.h>

#include "bake/effects/multiple/gather_multiple.h"
#include "bake/effects/multiple/sample_transport.h"
#include "bake/effects/multiple/walks/exit_light.h"
#include "bake/receivers/surface_samples.h"
#include "bake/transport/irradiance_transport.h"
#include "formats/opal/haar.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSize = 8, kAllOfThem = 6 * kSize * kSize;

// What the environment sends to a point, as light of another kind: in one band, or in three, of
// which green is half of red and blue none.
OtherLight copy_of_environment(const RayScene& rays, std::uint32_t bands) {
    OtherLight light;
    light.bands = bands;
    light.environment = false;
    light.add = [&rays, bands](const LitPoint& at, std::uint32_t n, std::span<float> rows) {
        std::vector<float> row(rows.size() / bands);
        const auto traced = gather_irradiance(rays, make_direction_set(n), at.receiver, row);
        formats::haar_forward_cube(std::span<float>(row), n);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            constexpr std::array<float, 3> kColour{1, 0.5f, 0};
            rows[k] += kColour[k / row.size()] * row[k % row.size()];
        }
        return traced;
    };
    return light;
}

struct OtherSetup {
    formats::Scene scene = tests::make_scene({tests::make_sphere(3)});
    RayScene rays = RayScene::build(scene, 1).value();
    std::vector<SurfaceSample> samples = sample_surface(scene, {0}, 600, 1, {});

    SampleTransport bake(const OtherLight* light) const {
        return bake_sample_transport(rays, samples, {kSize, kAllOfThem, 1, false, light}, {});
    }
};

// Through the tree: the same light as rows of the environment and as other light.
TEST(OtherLightOfMedia, EntersThroughSamplesAsTheEnvironmentDoes) {
    const OtherSetup setup;
    formats::Medium medium;
    medium.sigma_s = {4, 4, 4};
    medium.sigma_a = {0.1f, 0.1f, 0.1f};
    const MediumProfile profile = make_medium_profile(medium);
    const GatherProfile gather = make_gather_profile(profile, 0.15, 10);
    const ClusterTree plain =
        build_cluster_tree(setup.samples, setup.bake(nullptr), kSize, kAllOfThem, {});
    const OtherLight light = copy_of_environment(setup.rays, 3);
    const SampleTransport transport = setup.bake(&light);
    EXPECT_TRUE(transport.rows[5].index.empty());
    EXPECT_GT(transport.rays, 0u);
    const ClusterTree other =
        build_cluster_tree(setup.samples, transport, kSize, kAllOfThem, {}, kAllOfThem);
    std::vector<ClusterWeight> weights;
    // No clusters: the two sets of rays differ by quarters of texels, and so do their bounds.
    collect_weights(plain, gather, {0, -1, 0}, {0, -1, 0}, {0}, weights);
    std::vector<float> a(4 * kAllOfThem), b(4 * kAllOfThem);
    accumulate(plain, weights, a);
    accumulate(other, weights, b);
    double difference = 0, all = 0;
    for (std::size_t k = 0; k < a.size(); k += 4) {
        difference += std::pow(a[k] - b[k], 2);
        all += a[k] * a[k];
        EXPECT_NEAR(b[k + 1], 0.5f * b[k], 1e-5);
        EXPECT_EQ(b[k + 2], 0);
    }
    EXPECT_GT(all, 0);
    EXPECT_LT(std::sqrt(difference / all), 0.05) << "one ray a texel or four";
}

// Walks that forget their direction: an exit takes the light of its sample, whatever its kind.
TEST(OtherLightOfMedia, LeavesWalksAsTheEnvironmentDoes) {
    const OtherSetup setup;
    const OtherLight light = copy_of_environment(setup.rays, 1);
    const SampleTransport plain = setup.bake(nullptr), other = setup.bake(&light);
    const ExitLight environment(setup.samples, plain.rows, std::nullopt, 0.9);
    const ExitLight instead(setup.samples, other.rows, std::nullopt, 0.9, &other.other);
    for (const std::uint32_t sample : {3u, 77u, 310u}) {
        WalkExit exit;
        exit.direction = exit.normal = setup.samples[sample].normal;
        std::vector<float> a(4 * kAllOfThem), b(4 * kAllOfThem);
        exit.weight = {1, 1, 1};
        ExitCells::Sums sums{};
        ExitCells::Cells cells{};
        environment.add_exit(sample, exit, 1, sums);
        environment.add(sample, sums, {a, 4}, cells);
        instead.add(sample, sums, {b, 4}, cells);
        double sum = 0, same = 0;
        for (std::size_t k = 0; k < a.size(); k += kAllOfThem * 4 / 6) {
            sum += a[k];
            same += b[k];
        }
        EXPECT_GT(sum, 0);
        EXPECT_NEAR(same / sum, 1, 0.05) << "one ray a texel or four";
    }
}

}  // namespace
}  // namespace opaline::bake
