// Scenes by chance, few of them: tests/properties.sh bakes many. Those that failed once are tests
// of their own.
#include <gtest/gtest.h>

#include "tests/properties/physics.h"

namespace opaline::tests {
namespace {

void expect_right(const SceneWords& scene, const std::optional<Fault>& fault) {
    EXPECT_FALSE(fault) << fault->property << ": " << fault->detail << "\n" << describe(scene);
}

class ScenesByChance : public testing::TestWithParam<std::uint64_t> {};

TEST_P(ScenesByChance, KeepToPhysics) {
    const SceneWords scene = random_scene(GetParam());
    expect_right(scene, find_fault(scene));
}

// Cheap ones: twenty seconds together.
INSTANTIATE_TEST_SUITE_P(Seeds, ScenesByChance, testing::Range<std::uint64_t>(5005, 5030));

// .85 in the mean and black at 94 vertices, where two shells were counted around points just
// inside.
TEST(FoundScenes, AClearCupWithVerticesInThePlanesOfItsInnerWallsShowsTheSky) {
    const SceneWords cup = parse_scene("1 0 0; clear cup whole apart 0 0 1 1 1 0 1.5 0");
    expect_right(cup, find_fault(cup));
}

TEST(SceneWords, AreReadAsTheyAreWritten) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const std::string text = describe(random_scene(seed));
        EXPECT_EQ(describe(parse_scene(text)), text);
    }
}

}  // namespace
}  // namespace opaline::tests
