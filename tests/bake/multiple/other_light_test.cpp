#include <gtest/gtest.h>

#include <numeric>

#include "bake/effects/multiple/gather_multiple.h"
#include "bake/effects/multiple/sample_transport.h"
#include "bake/effects/multiple/walks/exit_light.h"
#include "bake/exchange/exchange_points.h"
#include "bake/exchange/other_light.h"
#include "bake/receivers/surface_samples.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/haar.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSize = 8, kAllOfThem = 6 * kSize * kSize;
constexpr std::uint32_t kPatchSize = 16, kAllPatches = 6 * kPatchSize * kPatchSize;

// Samples of a ball. Each is a patch whose light is another's; with what the environment sends to
// it, columns of patches make up the environment's.
struct OtherSetup {
    formats::Scene scene = tests::make_scene({tests::make_sphere(3)});
    RayScene rays = RayScene::build(scene, 1).value();
    std::vector<SurfaceSample> samples = sample_surface(scene, {0}, 600, 1, {});
    std::vector<Scatterer> scatterers = at_samples();
    BounceTree tree{scatterers, 1, 0};
    std::vector<std::uint32_t> patch = numbers();
    PatchLight columns{scatterers, tree, patch, {0}, patch};
    OtherLight light{.patches = &columns, .bands = 1, .environment = false};

    std::vector<Scatterer> at_samples() const {
        std::vector<Scatterer> made(samples.size());
        for (std::size_t i = 0; i < made.size(); ++i) {
            made[i].position = samples[i].receiver.origin;
            made[i].normal = samples[i].receiver.normal;
        }
        return made;
    }
    std::vector<std::uint32_t> numbers() const {
        std::vector<std::uint32_t> all(samples.size());
        std::iota(all.begin(), all.end(), 0u);
        return all;
    }
    SampleTransport bake(const OtherLight* other) const {
        const std::uint32_t size = other == nullptr ? kSize : kPatchSize;
        return bake_sample_transport(rays, samples, {size, kAllPatches, 1, false, other}, {});
    }
    // Row of the environment, from four values a patch of which the first counts.
    std::vector<float> under_environment(std::span<const float> patches) const {
        const DirectionSet directions = make_direction_set(kSize);
        std::vector<float> sum(kAllOfThem), row(kAllOfThem);
        for (std::size_t s = 0; s < samples.size(); ++s) {
            std::ranges::fill(row, 0.0f);
            gather_irradiance(rays, directions, samples[s].receiver, row);
            formats::haar_forward_cube(std::span<float>(row), kSize);
            for (std::size_t k = 0; k < row.size(); ++k) {
                sum[k] += patches[4 * s] * row[k];
            }
        }
        return sum;
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
    const SampleTransport transport = setup.bake(&setup.light);
    EXPECT_TRUE(transport.rows[5].index.empty());
    EXPECT_EQ(transport.rays, 0u);
    const ClusterTree other =
        build_cluster_tree(setup.samples, transport, kPatchSize, kAllPatches, {}, kAllPatches);
    std::vector<ClusterWeight> weights;
    // No clusters: the two sets of rays differ by quarters of texels, and so do their bounds.
    collect_weights(plain, gather, {0, -1, 0}, {0, -1, 0}, {0}, weights);
    std::vector<float> a(4 * kAllOfThem), b(4 * kAllPatches);
    accumulate(plain, weights, a);
    accumulate(other, weights, b);
    const std::vector<float> same = setup.under_environment(b);
    double difference = 0, all = 0;
    for (std::size_t k = 0; k < same.size(); ++k) {
        difference += std::pow(a[4 * k] - same[k], 2);
        all += a[4 * k] * a[4 * k];
    }
    EXPECT_GT(all, 0);
    EXPECT_LT(std::sqrt(difference / all), 0.05) << "one ray a texel or four";
}

// Walks that forget their direction: an exit takes the light of its sample, whatever its kind.
TEST(OtherLightOfMedia, LeavesWalksAsTheEnvironmentDoes) {
    const OtherSetup setup;
    const SampleTransport plain = setup.bake(nullptr), other = setup.bake(&setup.light);
    const ExitLight environment(setup.samples, plain.rows, std::nullopt, 0.9);
    const ExitLight instead(setup.samples, other.rows, std::nullopt, 0.9, &other.other);
    for (const std::uint32_t sample : {3u, 77u, 310u}) {
        WalkExit exit;
        exit.direction = exit.normal = setup.samples[sample].normal;
        std::vector<float> a(4 * kAllOfThem), b(4 * kAllPatches);
        exit.weight = {1, 1, 1};
        ExitCells::Sums sums{};
        ExitCells::Cells cells{};
        environment.add_exit(sample, exit, 1, sums);
        environment.add(sample, sums, {a, 4}, cells);
        instead.add(sample, sums, {b, 4}, cells);
        const std::vector<float> row = setup.under_environment(b);
        double sum = 0, same = 0;
        for (std::size_t k = 0; k < row.size(); k += row.size() / 6) {
            sum += a[4 * k];
            same += row[k];
        }
        EXPECT_GT(sum, 0);
        EXPECT_NEAR(same / sum, 1, 0.05) << "one ray a texel or four";
    }
}

}  // namespace
}  // namespace opaline::bake
