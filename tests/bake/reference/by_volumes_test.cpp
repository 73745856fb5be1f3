// Light that surfaces sent to volumes: a part of interreflection that paths tell apart.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/bake/reference/volume_support.h"

namespace opaline::tests {
namespace {

using bake::TermSet;

// Smoke that absorbs nothing above a white floor, practically without an end, in even light: all
// is as bright as the sky.
std::unique_ptr<ReferenceFixture> smoke_above_floor() {
    Scene scene = make_scene({make_quad({-500, -1, -500}, {0, 0, 1000}, {1000, 0, 0})});
    scene.materials[0].base_color = {1, 1, 1};
    scene.volumes.push_back(make_volume(make_ball_grid(0.5, 0.125), 2, 1, 0.5f));
    return make_fixture(std::move(scene), make_white_sky());
}

bake::PathOptions scattered_last_by_volumes() {
    bake::PathOptions options;
    options.terms = TermSet::volume_single | TermSet::volume_multiple | TermSet::interreflection;
    options.by_volumes = true;
    return options;
}

TEST(ByVolumes, SmokeGivesBackWhatItTakesWhateverIsBehindIt) {
    const auto smoke = smoke_above_floor();
    constexpr std::uint32_t kSamples = 1 << 15;
    const double taken = 1 - std::exp(-2.0);
    for (const glm::vec3 direction :
         {glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(1, 0, 0)}) {
        const bake::Moments seen =
            look(*smoke, -0.8f * direction, direction, scattered_last_by_volumes(), kSamples);
        EXPECT_NEAR(seen.mean.y, taken, 0.02) << direction.y;
    }
}

TEST(ByVolumes, NothingIsCountedOfAPathThatMeetsASurfaceFirst) {
    const auto smoke = smoke_above_floor();
    const bake::Moments beside =
        look(*smoke, {3, 0, 0}, {0, -1, 0}, scattered_last_by_volumes(), 4096);
    EXPECT_EQ(beside.mean.y, 0);
    bake::PathOptions all = scattered_last_by_volumes();
    all.by_volumes = false;
    EXPECT_GT(look(*smoke, {3, 0, 0}, {0, -1, 0}, all, 4096).mean.y, 0);
}

}  // namespace
}  // namespace opaline::tests
