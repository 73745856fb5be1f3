// Light that lamps send into volumes without surfaces, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "bake/effects/volumes/bake_glow.h"
#include "bake/effects/volumes/fit_nodes.h"
#include "bake/effects/volumes/place_nodes.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

constexpr double kFullPi = std::numbers::pi;

formats::Scene lit_scene(formats::Volume volume, glm::vec3 lamp, float intensity) {
    formats::Scene scene = tests::scene_of(std::move(volume));
    formats::Light light;
    light.name = "Bulb";
    light.position = lamp;
    light.intensity = {intensity, intensity, intensity};
    scene.lights.push_back(light);
    return scene;
}

/// Volumes as a bake shows them under their lamps alone.
class SmokeWithLamps {
  public:
    SmokeWithLamps(const formats::Scene& scene, Quality quality, double spacing)
        : rays_(tests::empty_space()) {
        Knobs knobs = tests::small_knobs(quality, spacing);
        knobs.cubemap_size = 4;
        volumes_ = tests::bake_volumes_of(scene, knobs);
        const VolumePlan plan = plan_volumes(scene, knobs);
        const VolumeJob job{scene, rays_, plan.layouts, knobs};
        const std::vector<Lamp> lamps = list_lamps(scene);
        std::uint64_t traced = 0;
        volumes_.glow = join_glow(
            volumes_.glow, bake_lamp_glow(job, place_nodes(job), {scene, lamps}, {}, traced));
        light_ = runtime::relight_volumes(volumes_.view(), {}, {.terms = formats::TermSet::none});
        lit_ = runtime::light_volumes(volumes_.view(), light_);
    }

    double see(glm::dvec3 from, glm::dvec3 direction) const {
        const auto vec3 = [](glm::dvec3 v) {
            const glm::vec3 f(v);
            return formats::Vec3{f.x, f.y, f.z};
        };
        return static_cast<double>(
            runtime::march_volumes(lit_, {vec3(from), vec3(direction)}).radiance.g);
    }

  private:
    RayScene rays_;
    formats::Volumes volumes_;
    runtime::VolumeLight light_;
    runtime::LitVolumes lit_;
};

// L = sigma_s / 4 pi int I / d^2 e^-(way in and out) ds, of a cube of optical depth 0.05.
TEST(LampsInVolumes, APointInThinSmokeGivesInverseSquaresAlongARay) {
    constexpr double kSigma = 0.025, kAlbedo = 0.2, kIntensity = 3;
    const glm::dvec3 lamp(0.13, -0.07, 0.05);
    const formats::Scene scene = lit_scene(
        tests::make_volume(tests::sample_grid(glm::dvec3(1), 0.125, [](glm::dvec3) { return 1.0; }),
                           static_cast<float>(kSigma), static_cast<float>(kAlbedo), 0),
        glm::vec3(lamp), static_cast<float>(kIntensity));
    const SmokeWithLamps smoke(scene, Quality::draft, 2);
    const formats::SparseGrid<float>& grid = scene.volumes[0].density;
    const glm::dmat4 to_index = glm::inverse(grid.to_scene);
    for (const double aside : {0.4, 0.6, 0.9}) {
        const glm::dvec3 from(-3, aside, 0.4), direction(1, 0, 0);
        double sum = 0, depth = 0;
        constexpr double kStep = 2e-3;
        for (double s = 0; s < 6; s += kStep) {
            const glm::dvec3 at = from + (s + kStep / 2) * direction;
            const double density =
                static_cast<double>(grid.sample(glm::vec3(to_index * glm::dvec4(at, 1))));
            const double distance = glm::length(at - lamp);
            depth += kSigma * density * kStep;
            sum += kSigma * kAlbedo * density / (4 * kFullPi) * kIntensity / (distance * distance) *
                   std::exp(-depth - kSigma * distance) * kStep;
        }
        EXPECT_NEAR(smoke.see(from, direction), sum, 0.05 * sum) << aside;
    }
}

// All that a point sends out leaves a white ball around it, scattered or not.
TEST(LampsInVolumes, AllPowerOfALampInAWhiteBallLeavesIt) {
    constexpr double kSigma = 4, kWide = 1.2;
    constexpr int kRings = 12, kTurns = 4;
    for (const glm::vec3 lamp : {glm::vec3(0), glm::vec3(0.06f, 0.02f, -0.03f)}) {
        const SmokeWithLamps smoke(lit_scene(tests::make_volume(tests::make_ball_grid(1, 0.125),
                                                                static_cast<float>(kSigma), 1, 0),
                                             lamp, 1),
                                   Quality::draft, 2);
        double leaves = 4 * kFullPi * std::exp(-kSigma);
        for (int side = 0; side < 6; ++side) {
            glm::dvec3 axis(0), across(0);
            axis[side % 3] = side < 3 ? 1 : -1;
            across[(side + 1) % 3] = 1;
            const glm::dvec3 along = glm::cross(axis, across);
            for (int i = 0; i < kRings * kTurns; ++i) {
                const double b = kWide * (i / kTurns + 0.5) / kRings;
                const double angle = 2 * kFullPi * (i % kTurns + 0.5) / kTurns;
                const glm::dvec3 off = b * (std::cos(angle) * across + std::sin(angle) * along);
                leaves += 4 * kFullPi / 6 * 2 * kFullPi * b * (kWide / kRings) / kTurns *
                          smoke.see(off - 4.0 * axis, axis);
            }
        }
        EXPECT_NEAR(leaves, 4 * kFullPi, 0.05 * 4 * kFullPi) << lamp.x;
    }
}

TEST(LampsInVolumes, SunsOfTheSceneLightThinSmokeEvenly) {
    formats::Scene scene = lit_scene(
        tests::make_volume(tests::make_ball_grid(1, 0.25), 0.01f, 0.5f, 0), glm::vec3(0), 2);
    scene.lights[0].type = formats::Light::Type::directional;
    const SmokeWithLamps smoke(scene, Quality::draft, 2);
    const double straight = 2 * 0.01 * 0.5 / (4 * kFullPi) * 2;  // b E / 4 pi over two metres
    EXPECT_NEAR(smoke.see({-3, 0, 0}, {1, 0, 0}), straight, 0.04 * straight);
}

TEST(FitNodes, ASpikeKeepsItsSumAndNothingBecomesDarkerThanNothing) {
    NodeLattice lattice;
    lattice.spacing = 2;
    for (int i = 0; i < 12; ++i) {
        lattice.node.emplace_back(2 * i, 0, 0);
    }
    std::uint64_t rays = 0;
    const auto lines = find_node_lines(lattice, glm::dmat4(1), tests::empty_space(), rays);
    ASSERT_EQ(lines[0].size(), 1u);
    EXPECT_TRUE(lines[1].empty());
    std::vector<glm::vec3> spike(12, glm::vec3(0.2f)), hill, even(12, glm::vec3(1));
    spike[6] = glm::vec3(5);
    const auto hill_at = [](float x) { return 1 + std::exp(-(x - 5) * (x - 5) / 8); };
    for (int i = 0; i < 12; ++i) {
        constexpr int kParts = 50;  // the mean over its tent
        float sum = 0;
        for (int k = -kParts; k <= kParts; ++k) {
            const float x = static_cast<float>(k) / kParts;
            sum += (1 - std::abs(x)) / kParts * hill_at(static_cast<float>(i) + x);
        }
        hill.emplace_back(sum);
    }
    const auto sum_of = [](const std::vector<glm::vec3>& values) {
        return std::accumulate(values.begin(), values.end(), glm::vec3(0)).x;
    };
    const float before = sum_of(spike);
    for (std::vector<glm::vec3>* values : {&spike, &hill, &even}) {
        fit_tent_means(lines, 1, *values);
    }
    EXPECT_NEAR(sum_of(spike), before, 0.01f * before);
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_GE(spike[i].x, 0.0199f) << i;
        EXPECT_NEAR(even[i].x, 1, 1e-5f) << i;
    }
    // Between two nodes the mean of the curve is that of the line.
    for (int i = 3; i < 8; ++i) {
        float mean = 0;
        for (int k = 0; k < 50; ++k) {
            mean += hill_at(static_cast<float>(i) + (static_cast<float>(k) + 0.5f) / 50) / 50;
        }
        const auto at = static_cast<std::size_t>(i);
        EXPECT_NEAR((hill[at].x + hill[at + 1].x) / 2, mean, 0.005f) << i;
    }
}

}  // namespace
}  // namespace opaline::bake
