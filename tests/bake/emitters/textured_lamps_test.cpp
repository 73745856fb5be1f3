// What surfaces reflect of lamps through textures finer than what it is averaged over.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/bake/emitters/bounced_lamps.h"

namespace opaline::bake {
namespace {

using tests::add_checker;
using tests::floor_under_ceiling;

// Light that the ceiling gets back from the floor, by vertex.
std::vector<double> returned_light(const formats::Scene& scene, bool is_filtered) {
    const ScenePyramids textures = make_scene_pyramids(scene);
    const ScenePyramids* const used = is_filtered ? &textures : nullptr;
    const auto rows = tests::BouncedLamps(scene, 0.05, {1000, 0, 0, 0, used}, 64).rows(0);
    std::vector<double> green;
    for (const formats::Rgb c : rows.at(0)) {
        green.push_back(static_cast<double>(c.g));
    }
    return green;
}

double difference_of(const std::vector<double>& a, const std::vector<double>& b) {
    double square = 0, all = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        square += (a[i] - b[i]) * (a[i] - b[i]);
        all += b[i] * b[i];
    }
    return std::sqrt(square / all);
}

// The same rays, which go no further than the floor.
TEST(TexturedLamps, AFineCheckerReflectsWhatItsMeanReflects) {
    formats::Scene checker = floor_under_ceiling(0.8f);
    checker.materials[1].base_color_image = add_checker(checker);
    const std::vector<double> mean = returned_light(floor_under_ceiling(0.4f), false);
    EXPECT_LT(difference_of(returned_light(checker, true), mean), 2e-3);
    EXPECT_GT(difference_of(returned_light(checker, false), mean), 0.03) << "as points have it";
}

}  // namespace
}  // namespace opaline::bake
