#include "bake/lab/path_images/path_image.h"

#include <cmath>
#include <numbers>

#include "bake/physics/phase.h"
#include "tests/bake/path_images/path_image_support.h"

namespace opaline::tests {
namespace {

using formats::TermSet;

using std::numbers::pi;

// A slab between y = 0 and -1, soft over a voxel at its faces, so wide that no ray here meets a
// side.
formats::Volume make_slab_volume(float depth, float albedo, float g) {
    constexpr int kVoxels = 16;
    auto grid = formats::fill_grid({-32, -kVoxels, -32}, {32, -1, 32}, 1.0 / kVoxels,
                                   [](glm::ivec3) { return 1.0; });
    grid.to_scene[3] = glm::dvec4(0, 0.5 / kVoxels, 0, 1);
    return make_volume(std::move(grid), depth, albedo, g);
}

// Beer's law on the way in and out, integrated over depth: L = albedo p E (1 - e^(-tau (1/mu +
// 1/mu'))) / (1 + mu / mu').
TEST(PathImage, SlabScattersOnceAsItsClosedFormSays) {
    const glm::dvec3 to_sun = glm::normalize(glm::dvec3(0.5, 0.6, 0.2));
    const glm::dvec3 view = glm::normalize(glm::dvec3(0.1, -0.9, 0.3));
    for (const float depth : {0.5f, 2.0f, 8.0f, 16.0f}) {
        const auto scene = make_volume_scene(make_slab_volume(depth, 0.9f, 0.6f),
                                             make_distant_light(glm::vec3(to_sun)));
        const double mu = -view.y, sun = to_sun.y;
        const double truth = 0.9 * bake::henyey_greenstein(glm::dot(view, to_sun), 0.6) *
                             -std::expm1(-depth * (1 / mu + 1 / sun)) / (1 + mu / sun);
        const glm::dvec3 seen = look_along(*scene, glm::vec3(-2.0 * view), glm::vec3(view),
                                           plain(TermSet::volume_single));
        // What is left where a voxel is half a mean free path, or a whole one: V within steps.
        EXPECT_NEAR(seen.x / truth, 1, depth > 8 ? 0.055 : depth > 4 ? 0.035 : 0.02) << depth;
    }
}

TEST(PathImage, SkyBehindIsDimmedByBeersLaw) {
    const auto scene = make_volume_scene(make_slab_volume(1.5f, 0, 0), make_white_sky());
    bake::PathImageOptions options = plain(TermSet::all);
    EXPECT_NEAR(look_along(*scene, {0.3f, 2, 0.1f}, {0, -1, 0}, options).x, std::exp(-1.5), 1e-3);
}

// A furnace asks for depths in 96 directions, so that its balls have larger voxels.
formats::Volume make_ball_volume(float depth, float albedo, float g, double voxel = 1.0 / 16) {
    return make_volume(make_ball_grid(1, voxel), depth / 2, albedo, g);
}
constexpr double kLarge = 1.0 / 6;

TEST(PathImage, BallInAWhiteFurnaceVanishesWithRenormalisation) {
    for (const auto& [g, depth] : {std::pair{0.5f, 2.0f}, {0.9f, 12.0f}}) {
        const auto scene =
            make_volume_scene(make_ball_volume(depth, 1, g, kLarge), make_white_sky());
        for (const float aside : {0.0f, 0.6f}) {
            bake::PathImageOptions options;
            options.renormalise = true;
            const auto look = [&] {
                return look_along(*scene, {aside, 0, -3}, {0, 0, 1}, options).x;
            };
            EXPECT_NEAR(look(), 1, 0.01) << g << ' ' << depth << ' ' << aside;
            options.renormalise = false;
            EXPECT_NEAR(look(), 1, 0.2) << g << ' ' << depth << ' ' << aside;
        }
    }
}

// The factor is that of a white furnace, whatever lights the picture.
TEST(PathImage, FactorOfARayInTheFurnaceIsTheSameUnderASunAsUnderASky) {
    const auto factor = [](const formats::Environment& light) {
        const auto scene = make_volume_scene(make_ball_volume(12, 1, 0.9f, kLarge), light);
        bake::PathImageOptions options = plain(TermSet::volume_multiple);
        const auto look = [&] { return look_along(*scene, {0.6f, 0, -3}, {0, 0, 1}, options).x; };
        const double as_it_is = look();
        options.renormalise = true;
        return look() / as_it_is;
    };
    const double under_sky = factor(make_white_sky());
    EXPECT_GT(std::abs(under_sky - 1), 0.01);
    EXPECT_NEAR(factor(make_distant_light({0, 1, 0})) / under_sky, 1, 1e-5);
}

TEST(PathImage, ChannelsOfOtherCoefficientsAreThoseOfGreyMedia) {
    const formats::Environment light = make_distant_light({0, 1, 0});
    formats::Volume colored = make_ball_volume(2, 0.9f, 0.5f);
    colored.sigma_t = {1, 3, 1};
    const glm::dvec3 seen = look_along(*make_volume_scene(colored, light), {0, 0, -3}, {0, 0, 1},
                                       plain(TermSet::volume_multiple));
    for (const int c : {0, 1, 2}) {
        formats::Volume grey = colored;
        const float sigma = c == 1 ? 3.0f : 1.0f;
        grey.sigma_t = {sigma, sigma, sigma};
        EXPECT_EQ(look_along(*make_volume_scene(grey, light), {0, 0, -3}, {0, 0, 1},
                             plain(TermSet::volume_multiple))[c],
                  seen[c]);
    }
}

TEST(PathImage, HasTheSameBitsForAnyNumberOfThreads) {
    const auto scene = make_volume_scene(make_ball_volume(4, 0.9f, 0.5f, kLarge), make_white_sky());
    runtime::Camera camera = camera_along({0, 0, -5}, {0, 0, 1}, 12);
    camera.fov_y = 30;
    const bake::PathImage first = draw(*scene, camera, {}, 1);
    for (const unsigned threads : {2u, 3u}) {
        EXPECT_EQ(draw(*scene, camera, {}, threads).radiance.pixel, first.radiance.pixel);
    }
}

TEST(PathImage, FloorBehindAVolumeIsLitAndSeenThroughIt) {
    const auto scene = make_volume_scene(make_ball_volume(1, 0.5f, 0),
                                         make_distant_light({0, 1, 0}), make_square(-2));
    const double seen = look_along(*scene, {0, 3, 0.001f}, {0, -1, 0}, plain(TermSet::diffuse)).x;
    EXPECT_NEAR(seen * pi, std::exp(-2), 0.01);
    const double beside =
        look_along(*scene, {1.6f, 3, 1.6f}, {0, -1, 0}, plain(TermSet::diffuse)).x;
    EXPECT_NEAR(beside * pi, 1, 1e-4);
}

TEST(PathImage, SurfaceBetweenAVolumeAndTheSunShadowsIt) {
    const auto look = [](float square) {
        const auto scene = make_volume_scene(make_ball_volume(2, 0.9f, 0.5f),
                                             make_distant_light({0, 1, 0}), make_square(square));
        return look_along(*scene, {0, 0, -4}, {0, 0, 1},
                          plain(TermSet::volume_single | TermSet::volume_multiple))
            .x;
    };
    EXPECT_GT(look(-1.5f), 0.01);
    EXPECT_EQ(look(1.5f), 0);
}

// Both forms estimate the same light: a surface deep inside, behind most of what is seen.
TEST(PathImage, RayThatASurfaceEndsInsideAVolumeKeepsItsLight) {
    const formats::Environment light = make_distant_light(glm::normalize(glm::vec3(0.2f, 1, 0)));
    const auto look = [&](float square) {
        const auto scene =
            make_volume_scene(make_ball_volume(16, 0.9f, 0.5f), light, make_square(square));
        return look_along(*scene, {0, 3, 0.001f}, {0, -1, 0}, plain(TermSet::volume_multiple)).x;
    };
    EXPECT_NEAR(look(-0.7f) / look(-1.5f), 1, 0.35);
}

TEST(PathImage, ScenesItCannotComputeAreRefusedWithARemedy) {
    Scene scene = make_square(0);
    auto status = bake::check_path_scene(scene);
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().diagnostics.front().fault.find("has none"), std::string::npos);
    scene.volumes = {make_ball_volume(1, 1, 0.5f), make_ball_volume(1, 1, 0.6f)};
    EXPECT_FALSE(bake::check_path_scene(scene));
    scene.volumes.pop_back();
    EXPECT_TRUE(bake::check_path_scene(scene));
    scene.materials[0].medium = make_medium(1, 0.9f, 0, 1.3f);
    EXPECT_FALSE(bake::check_path_scene(scene));
}

}  // namespace
}  // namespace opaline::tests
