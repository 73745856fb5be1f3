// What translucent surfaces send to each other, against path tracing.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bake/check/check_model.h"
#include "bake/check/model_pairs.h"
#include "bake/effects/interreflection/interreflection.h"
#include "runtime/light_vector.h"
#include "tests/support/walk_bake.h"

namespace opaline::bake {
namespace {

// A block with a slot three transport mean free paths wide and deep, whose walls and bottom come
// first: light that leaves them arrived beside them as well.
tests::Scene make_slotted_block(std::size_t& of_slot) {
    constexpr std::uint32_t kCells = 8;
    constexpr std::array<float, 4> kX{-5.5f, -1.5f, 1.5f, 5.5f};
    constexpr std::array<float, 3> kY{-7, -3, 0};
    constexpr float kEnd = 6;
    const glm::vec3 along{0, 0, 2 * kEnd};
    std::vector<tests::Primitive> slot, rest;
    const auto is_filled = [](int x, int y) {
        return x >= 0 && x < 3 && y >= 0 && y < 2 && !(x == 1 && y == 1);
    };
    for (int x = 0; x < 3; ++x) {
        for (int y = 0; y < 2; ++y) {
            if (!is_filled(x, y)) continue;
            const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
            const glm::vec3 low{kX[i], kY[j], -kEnd}, across{kX[i + 1] - kX[i], 0, 0},
                up{0, kY[j + 1] - kY[j], 0};
            const auto add = [&](int to_x, int to_y, glm::vec3 corner, glm::vec3 a, glm::vec3 b) {
                if (!is_filled(x + to_x, y + to_y)) {
                    const bool is_in_slot = x + to_x == 1 && y + to_y == 1;
                    (is_in_slot ? slot : rest).push_back(tests::make_quad(corner, a, b, kCells));
                }
            };
            add(1, 0, low + across, up, along);
            add(-1, 0, low, along, up);
            add(0, 1, low + up, along, across);
            add(0, -1, low, across, along);
            rest.push_back(tests::make_quad(low, up, across, kCells));
            rest.push_back(tests::make_quad(low + along, across, up, kCells));
        }
    }
    of_slot = slot.size();
    slot.insert(slot.end(), rest.begin(), rest.end());
    return tests::make_translucent_scene(std::move(slot),
                                         tests::make_grey_medium(0.95f, 0.05f, 1.4f));
}

BakeOptions walk_bake(bool separate) {
    BakeOptions options = bake_by(kWalked);
    options.separate_terms = separate;
    options.effects = {"multiple", "single"};
    return options;
}

// Of what files of some effects show at receivers under white light, what comes from other
// surfaces, added up.
double sum_bounced(const tests::Scene& scene, std::span<const ReferenceReceiver> receivers,
                   BakeOptions options) {
    double sum = 0;
    for (const double sign : {-1.0, 1.0}) {
        if (sign > 0) {
            options.effects.emplace_back("interreflection");
        }
        const BakeResult baked = tests::bake_scene(scene, options);
        const runtime::LightVector light =
            tests::make_light("white", baked.asset.view().cubemap_size);
        for (const double shown :
             relight_receivers(baked.asset.view(), receivers, {.vector = light})) {
            sum += sign * shown;
        }
    }
    return sum;
}

// What path tracing has of that light at the same receivers.
struct TracedSum {
    double light = 0, error = 0;  // its standard error
};
TracedSum trace_bounced(const tests::Scene& scene, const ModelProbes& probes) {
    EXPECT_EQ(probes.lights.at(0).name, "white");
    ModelCheckOptions effort;
    effort.simulated = TermSet::interreflection;
    effort.max_events = 1500000;
    const LightCheck truth = trace_model_truth(scene, probes, effort, {}).value().front();
    EXPECT_GT(truth.pairs.size(), 100u);
    TracedSum sum;
    double variance = 0;
    for (const ModelPair& pair : truth.pairs) {
        sum.light += pair.truth;
        variance += pair.variance;
    }
    sum.error = std::sqrt(variance);
    EXPECT_LT(sum.error, 0.02 * sum.light);
    return sum;
}

std::vector<ReferenceReceiver> choose_in_slot(const tests::Scene& scene, std::size_t of_slot) {
    auto probes = choose_model_probes(scene, 4000, 0, {}).value();
    std::erase_if(probes.receivers,
                  [&](const ReferenceReceiver& r) { return r.primitive >= of_slot; });
    return probes.receivers;
}

// Under white light. Light that reaches a wall leaves beside it as well, some of it from outside of
// the slot: patch by patch, as the medium answers.
TEST(BouncedMedia, WallsOfASlotSendEachOtherHardlyMoreThanPathTracingFinds) {
    std::size_t of_slot = 0;
    const tests::Scene scene = make_slotted_block(of_slot);
    ASSERT_EQ(of_slot, 3u);
    ModelProbes probes = choose_model_probes(scene, 0, 0, {}).value();
    probes.receivers = choose_in_slot(scene, of_slot);
    probes.lights.resize(1);
    const TracedSum traced = trace_bounced(scene, probes);
    const double sum = sum_bounced(scene, probes.receivers, walk_bake(false));
    std::printf("slot: %.3f of the truth, whose error is %.3f\n", sum / traced.light,
                traced.error / traced.light);
    EXPECT_GT(sum, 0.9 * traced.light);
    EXPECT_LT(sum, 1.12 * traced.light);
}

// A dielectric as black as ink on a floor: what the floor has of it is mirrored, most of it at
// grazing angles, where a rough boundary mirrors less.
void expect_mirrored(float roughness) {
    tests::Primitive floor =
        tests::make_quad({-2.45f, -1.001f, -2.45f}, {0, 0, 4.9f}, {4.9f, 0, 0}, 40);
    floor.material = 1;
    tests::Scene scene = tests::make_translucent_scene(
        {std::move(floor), tests::make_cube(6, false)}, tests::make_grey_medium(0, 1000, 1.6f));
    scene.materials[0].medium->roughness = roughness;
    scene.materials[1].base_color = {0.5f, 0.5f, 0.5f};
    ModelProbes probes = choose_model_probes(scene, 600, 0, {}).value();
    // Those of the floor that see the sky.
    std::erase_if(probes.receivers, [&](const ReferenceReceiver& r) {
        const glm::vec3 x = scene.primitives[r.primitive].position[r.vertex];
        return r.primitive != 0 || std::max(std::abs(x.x), std::abs(x.z)) < 1.05f;
    });
    probes.lights.resize(1);
    const TracedSum traced = trace_bounced(scene, probes);
    BakeOptions options = tests::only({"direct", "specular"});
    options.quality = Quality::draft;
    options.set(kBounceRays, 256);
    const double sum = sum_bounced(scene, probes.receivers, options);
    std::printf("floor: %.4f, %.3f of the truth, whose error is %.3f\n", sum, sum / traced.light,
                traced.error / traced.light);
    EXPECT_NEAR(sum / traced.light, 1, 0.03);
}

TEST(BouncedMedia, AFloorReceivesWhatABlackBodyOnItMirrors) {
    expect_mirrored(0);
}

TEST(BouncedMedia, AFloorReceivesWhatARoughBlackBodyOnItMirrors) {
    expect_mirrored(0.4f);
}

// The effect that light scattered once may have to itself knows of the sky alone.
TEST(BouncedMedia, LightFromOtherSurfacesIsTheSameWhetherWhatScattersOnceStandsApart) {
    std::size_t of_slot = 0;
    const tests::Scene scene = make_slotted_block(of_slot);
    const auto receivers = choose_in_slot(scene, of_slot);
    const double together = sum_bounced(scene, receivers, walk_bake(false)),
                 apart = sum_bounced(scene, receivers, walk_bake(true));
    std::printf("apart: %.3f of together\n", apart / together);
    EXPECT_NEAR(apart / together, 1, 0.06);
}

}  // namespace
}  // namespace opaline::bake
