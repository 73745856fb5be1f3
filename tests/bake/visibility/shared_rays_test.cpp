#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/receivers/kd_order.h"
#include "bake/receivers/surface_samples.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSize = 16;

struct Gathered {
    std::vector<float> own, shared;  // dense transport of all samples
    std::uint64_t own_rays = 0, shared_rays = 0;
    std::size_t samples = 0;
};

Gathered gather_both(const formats::Scene& scene, std::uint32_t count) {
    const auto rays = RayScene::build(scene, 1);
    const auto samples = sample_surface(scene, {0}, count, 1, {});
    const SharedDirections directions = make_shared_directions(kSize);
    const std::size_t texels = formats::cubemap_texels(kSize);
    Gathered both;
    both.samples = samples.size();
    both.own.resize(samples.size() * texels);
    both.shared.resize(samples.size() * texels);
    for (std::size_t s = 0; s < samples.size(); s += kSamplesPerGroup) {
        std::vector<Receiver> group;
        for (std::size_t i = s; i < std::min(samples.size(), s + kSamplesPerGroup); ++i) {
            both.own_rays +=
                gather_irradiance(*rays, directions.sets[(i - s) % 4], samples[i].receiver,
                                  std::span(both.own).subspan(i * texels, texels));
            group.push_back(samples[i].receiver);
        }
        both.shared_rays += gather_irradiance_together(
            *rays, directions, group,
            std::span(both.shared).subspan(s * texels, group.size() * texels));
    }
    return both;
}

double sum(const std::vector<float>& values) {
    double total = 0;
    for (const float value : values) {
        total += static_cast<double>(value);
    }
    return total;
}

TEST(SharedRays, ConvexBodiesSeeWhatTheySeeAlone) {
    const Gathered ball = gather_both(tests::make_scene({tests::make_sphere(3)}), 640);
    EXPECT_EQ(ball.own, ball.shared);
    EXPECT_LT(ball.shared_rays, ball.own_rays / 12);
}

TEST(SharedRays, FloorUnderABallKeepsItsShadow) {
    tests::Primitive ball = tests::make_sphere(3);
    for (glm::vec3& p : ball.position) {
        p.y += 1.5f;
    }
    const Gathered floor = gather_both(
        tests::make_scene({tests::make_quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, 8), ball}), 4000);
    double wrong = 0, all = 0;
    for (std::size_t k = 0; k < floor.own.size(); ++k) {
        wrong += std::pow(static_cast<double>(floor.own[k] - floor.shared[k]), 2);
        all += std::pow(static_cast<double>(floor.own[k]), 2);
    }
    EXPECT_LT(std::sqrt(wrong / all), 0.02);
    EXPECT_NEAR(sum(floor.shared) / sum(floor.own), 1, 2e-4);
    EXPECT_LT(floor.shared_rays, floor.own_rays / 2);
}

// Bars a quarter of a texel wide, five texels apart: a coarse grid of rays would miss most of them.
TEST(SharedRays, NarrowBarsCastTheirShadow) {
    std::vector<tests::Primitive> parts{
        tests::make_quad({-0.5f, 0, -0.5f}, {0, 0, 1}, {1, 0, 0}, 4)};
    for (int i = -3; i <= 3; ++i) {
        const float x = static_cast<float>(i) * 0.6f;
        parts.push_back(tests::make_quad({x - 0.015f, 1, -3}, {0, 0, 6}, {0.03f, 0, 0}, 1));
    }
    const Gathered open = gather_both(tests::make_scene({parts.front()}), 640);
    const Gathered barred = gather_both(tests::make_scene(parts), 640);
    const double shadow = sum(open.own) - sum(barred.own);
    ASSERT_GT(shadow, 0.02 * sum(open.own));
    EXPECT_NEAR((sum(open.shared) - sum(barred.shared)) / shadow, 1, 0.1);
}

TEST(SharedRays, BlocksBorderOnEachOther) {
    for (const std::uint32_t n : {8u, 32u}) {
        const auto beside = make_shared_directions(n).beside;
        std::size_t one_sided = 0, lonely = 0;
        for (std::uint32_t a = 0; a < beside.size(); ++a) {
            lonely += beside[a].size() < 4 ? 1 : 0;
            for (const std::uint32_t b : beside[a]) {
                one_sided += std::count(beside[b].begin(), beside[b].end(), a) == 1 ? 0 : 1;
            }
        }
        EXPECT_EQ(lonely, 0u) << n;
        EXPECT_EQ(one_sided, 0u) << n;
    }
}

}  // namespace
}  // namespace opaline::bake
