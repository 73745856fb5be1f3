// Light that crossed a body unscattered and met more: a part of interreflection that paths tell
// apart.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

using bake::CrossedLight;
using bake::TermSet;

// A slab of the medium, practically without an end, above a floor of albedo 1/2.
Scene slab_above_floor(const formats::Medium& medium) {
    Scene scene = make_slab(medium, 1);
    Primitive floor = make_quad({-300, -0.6f, -300}, {0, 0, 600}, {600, 0, 0});
    floor.material = 1;
    scene.primitives.push_back(floor);
    scene.materials.push_back({.name = "Floor"});
    scene.materials[1].base_color = {0.5f, 0.5f, 0.5f};
    return scene;
}

// Straight down on the slab under white light.
bake::Moments look_at_slab(const ReferenceFixture& fixture, TermSet terms, CrossedLight crossed,
                           std::uint32_t samples) {
    bake::PathOptions options;
    options.terms = terms;
    options.crossed = crossed;
    return look_down(fixture.space(options), 0.5f, 1, samples);
}

// Every path crosses the slab, straight: the radiance is the floor's, 1/2.
TEST(CrossedLight, IsAllThatAClearSlabShowsOfItsFloor) {
    const auto clear =
        make_fixture(slab_above_floor(make_medium(1e-6f, 0, 0, 1)), make_white_sky());
    const TermSet more = TermSet::interreflection;
    EXPECT_NEAR(look_at_slab(*clear, more, CrossedLight::alone, 4096).mean.y, 0.5, 0.01);
    EXPECT_EQ(look_at_slab(*clear, more, CrossedLight::left_out, 4096).mean.y, 0);
    EXPECT_EQ(look_at_slab(*clear, TermSet::all & ~more, CrossedLight::alone, 4096).mean.y, 0);
}

// Both parts are there, and they add up.
TEST(CrossedLight, AndTheOtherAddUpToInterreflection) {
    const auto slab =
        make_fixture(slab_above_floor(make_medium(1, 0.9f, 0, 1.3f)), make_white_sky());
    constexpr std::uint32_t kSamples = 1 << 17;
    const bake::Moments all =
        look_at_slab(*slab, TermSet::interreflection, CrossedLight::counted, kSamples);
    const bake::Moments alone =
        look_at_slab(*slab, TermSet::interreflection, CrossedLight::alone, kSamples);
    const bake::Moments other =
        look_at_slab(*slab, TermSet::interreflection, CrossedLight::left_out, kSamples);
    EXPECT_GT(alone.mean.y, 0.02);
    EXPECT_GT(other.mean.y, 0.02);
    EXPECT_NEAR(alone.mean.y + other.mean.y, all.mean.y,
                4 * std::sqrt(alone.variance_of_mean().x + other.variance_of_mean().x +
                              all.variance_of_mean().x));
}

}  // namespace
}  // namespace opaline::tests
