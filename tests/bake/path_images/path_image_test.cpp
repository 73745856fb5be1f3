#include <cmath>
#include <numbers>

#include "bake/lab/path_images/path_image.h"
#include "bake/physics/phase.h"
#include "tests/bake/path_images/path_image_support.h"
#include "tests/support/volume_table.h"

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

bool is_grid(const VolumeRow& row) {
    return row.cell.at("geometry") == "blob" || row.cell.at("geometry") == "sphere";
}

// The ray of a row through its body as a grid, under its light of unit irradiance.
double look_at_row(const VolumeRow& row, const bake::PathImageOptions& options) {
    const auto of = [&](const char* name) {
        return glm::vec3(row.number(std::string(name) + "x"), row.number(std::string(name) + "y"),
                         row.number(std::string(name) + "z"));
    };
    const auto size = row.number("size");
    auto grid = row.cell.at("geometry") == "blob" ? make_blob(size, size / 8)
                                                  : make_ball_grid(size, size / 20);
    const auto scene = make_volume_scene(
        make_volume(std::move(grid), static_cast<float>(row.number("sigma_t")),
                    static_cast<float>(row.number("albedo")), static_cast<float>(row.number("g"))),
        make_distant_light(of("l")));
    // From outside: the grid is not cut as sharply as the ball.
    return look_along(*scene, of("p") - static_cast<float>(size) * of("v"), of("v"), options).x;
}

TEST(PathImageRows, LightScatteredOnceIsThatOfItsIntegralAlongTheRay) {
    OPALINE_VOLUME_ROWS(rows, "order1");
    for (const VolumeRow& row : rows) {
        if (is_grid(row)) {
            EXPECT_NEAR(look_at_row(row, plain(TermSet::volume_single)) / row.value(), 1, 0.02)
                << row.id();
        }
    }
}

TEST(PathImageRows, LightScatteredOftenIsThatOfThePathIntegral) {
    OPALINE_VOLUME_ROWS(rows, "pi_L2plus");
    for (const VolumeRow& row : rows) {
        bake::PathImageOptions options = plain(TermSet::volume_multiple);
        options.lengths = {row.number("arg")};
        // The grid softens the ball's rim.
        EXPECT_NEAR(look_at_row(row, options) / row.value(), 1, 0.03) << row.id();
    }
}

// Against Monte Carlo: to 15 %, but along a ball's rim the model is a factor of two off.
TEST(PathImageRows, LightScatteredOftenIsRightTo15PercentButAlongARim) {
    OPALINE_VOLUME_ROWS(rows, "order2plus");
    for (const VolumeRow& row : rows) {
        if (is_grid(row)) {
            bake::PathImageOptions options = plain(TermSet::volume_multiple);
            const bool is_rim = std::abs(row.number("px")) > 0.5 * row.number("size") &&
                                row.cell.at("geometry") == "sphere";
            EXPECT_NEAR(look_at_row(row, options) / row.value(), 1, is_rim ? 1.15 : 0.15)
                << row.id();
        }
    }
}

// Balls of radius 1 and a sun in the plane of the ray: where the ray passes, on the sun's side if
// aside > 0. Truth: `bake::trace_ray`, 320000 paths through the same grid, orders of two and more
// [1/sr per unit irradiance]; its standard error is 0.3 to 1.8 %.
struct Ray {
    double aside, truth;
};
struct Sun {
    double cosine;  // between the ray, away from the eye, and the direction toward the sun
    Ray middle[2], rim;
};
struct Body {
    float g, albedo, depth;  // optical, along the diameter
    Sun ahead, side, behind;
};
constexpr Body kThin{0.75f,
                     0.9f,
                     2,
                     {0.9, {{0, 0.11534}, {0.3, 0.11577}}, {-0.6, 0.09425}},
                     {0.2, {{0, 0.024593}, {0.3, 0.022597}}, {-0.6, 0.019141}},
                     {-0.95, {{0, 0.0076902}, {0.3, 0.0072802}}, {-0.6, 0.0061229}}};
constexpr Body kThick{0.5f,
                      0.95f,
                      4,
                      {0.9, {{0, 0.061033}, {0.3, 0.070021}}, {-0.6, 0.050398}},
                      {0.2, {{0, 0.055874}, {0.3, 0.065466}}, {-0.6, 0.029059}},
                      {-0.95, {{0, 0.042456}, {0.3, 0.041969}}, {-0.6, 0.033154}}};

// Path integration over the truth.
double ratio_of(const Body& body, const Sun& sun, const Ray& ray) {
    const auto light = make_distant_light(
        glm::vec3(std::sqrt(1 - sun.cosine * sun.cosine), 0, static_cast<float>(sun.cosine)));
    const auto scene = make_volume_scene(
        make_volume(make_ball_grid(1, 1.0 / 16), body.depth / 2, body.albedo, body.g), light);
    return look_along(*scene, {static_cast<float>(ray.aside), 0, -3}, {0, 0, 1},
                      plain(TermSet::volume_multiple))
               .x /
           ray.truth;
}

void expect_through_the_middle(const Body& body, const Sun& sun, double tolerance) {
    for (const Ray& ray : sun.middle) {
        EXPECT_NEAR(ratio_of(body, sun, ray), 1, tolerance) << sun.cosine << ' ' << ray.aside;
    }
}

// Half a transport mean free path wide: the case for which the method is made.
TEST(PathAccuracy, OfAThinBodyLightFromAheadIsRightTo6PercentAndFromTheSideTo13) {
    expect_through_the_middle(kThin, kThin.ahead, 0.06);
    expect_through_the_middle(kThin, kThin.side, 0.13);
}

// Two transport mean free paths wide. A furnace's factor, left out here, halves the errors.
TEST(PathAccuracy, OfAThickBodyLightFromAheadIsTooBrightByUpTo30PercentAndFromTheSideBy18) {
    expect_through_the_middle(kThick, kThick.ahead, 0.30);
    expect_through_the_middle(kThick, kThick.side, 0.18);
}

TEST(PathAccuracy, LightFromBehindTheEyeAndAlongRimsIsWithinAFactorOf2Point1) {
    for (const Body& body : {kThin, kThick}) {
        for (const Ray& ray : body.behind.middle) {
            const double ratio = ratio_of(body, body.behind, ray);
            EXPECT_TRUE(ratio > 0.55 && ratio < 1.05) << body.g << ' ' << ray.aside << ' ' << ratio;
        }
        for (const Sun& sun : {body.ahead, body.side, body.behind}) {
            const double ratio = ratio_of(body, sun, sun.rim);
            EXPECT_TRUE(ratio > 1.05 && ratio < 2.1) << body.g << ' ' << sun.cosine << ' ' << ratio;
        }
    }
}

}  // namespace

}  // namespace opaline::tests
