// Pictures whose textures are filtered over footprints.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bake/reference/reference_receivers.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/bake/reference/textured_board.h"

namespace opaline::tests {
namespace {

using bake::TextureFiltering;

/// The board seen in a rough mirror.
struct View {
    std::unique_ptr<ReferenceFixture> fixture;
    TextureFiltering filtering;
    runtime::Camera camera;

    bake::ReferenceImage picture(bool filtered, std::uint32_t samples, std::uint64_t seed) const {
        bake::PathOptions paths;
        paths.max_depth = 2;
        const bake::PathSpace space{fixture->scene, fixture->light, paths,
                                    filtered ? &filtering : nullptr};
        bake::EstimateOptions options;
        options.samples = samples;
        options.seed = seed;
        auto image = bake::estimate_image(space, camera, options, {});
        EXPECT_TRUE(image);
        return std::move(*image);
    }
    std::vector<double> pixels(bool filtered, std::uint32_t samples, std::uint64_t seed) const {
        const bake::ReferenceImage image = picture(filtered, samples, seed);
        std::vector<double> values;
        for (const formats::Rgb& c : image.mean.pixel) {
            values.push_back(static_cast<double>(c.g));
        }
        return values;
    }
};
View board_in_mirror(float roughness) {
    Scene scene = textured_board(0, 40);
    // A mirror over the middle of the board, facing down, high above it; the eye is between.
    scene.primitives.push_back(make_quad({-1, 0.5f, -1}, {2, 0, 0}, {0, 0, 2}));
    scene.primitives[1].material = 1;
    formats::Material& mirror = scene.materials.emplace_back();
    mirror.gloss.metallic = mirror.gloss.specular = 1;
    mirror.gloss.roughness = roughness;
    // The board is lit evenly, from below and through it, so that nothing but the texture varies.
    scene.materials[0].double_sided = true;
    scene.materials[0].sheet = formats::Sheet{{0, 0, 0}, {1, 1, 1}};
    formats::Light& sun = scene.lights.emplace_back();
    sun.type = formats::Light::Type::directional;
    sun.direction = {0, 1, 0};
    View view{make_fixture(std::move(scene), {}), {}, {}};
    view.filtering = filtering_of(view.fixture->input, 4);
    view.camera.eye = {0, 0.25f, 0.2f};
    view.camera.target = {0, 0.5f, 0};
    view.camera.fov_y = 30;
    view.camera.width = view.camera.height = 12;
    return view;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

// By a factor of 2 and more on each seed, and to first order the mean is the same.
TEST(FilteredPicture, ErrorOfAGlossyReflectionOfATextureFalls) {
    const View view = board_in_mirror(0.35f);
    const std::vector<double> truth = view.pixels(false, 1024, 99);
    double sum = 0, whole = 0;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        const std::vector<double> filtered = view.pixels(true, 4, seed);
        EXPECT_GT(
            rms_difference(view.pixels(false, 4, seed), truth) / rms_difference(filtered, truth),
            2);
        for (std::size_t i = 0; i < truth.size(); ++i) {
            sum += filtered[i] - truth[i];
            whole += truth[i];
        }
    }
    EXPECT_LT(std::abs(sum / whole), 0.01);
}

TEST(FilteredPicture, PathsAreTheSame) {
    View view = board_in_mirror(0.35f);
    for (std::uint8_t& code : view.fixture->input.images[0].rgba) {
        code = code == 0 ? 180 : code;  // bright enough that no path ends for its throughput
    }
    view.filtering = filtering_of(view.fixture->input, 16);
    const bake::ReferenceImage plain = view.picture(false, 16, 1), with = view.picture(true, 16, 1);
    EXPECT_EQ(plain.estimate.events, with.estimate.events);
    EXPECT_EQ(plain.estimate.lost, with.estimate.lost);
}

// A filter that finds no varied texture changes no bit; footprints below a texel change none
// either.
TEST(FilteredPicture, EvenTexturesAndSmallFootprintsAreLookedUpAtPoints) {
    View view = board_in_mirror(0.35f);
    const std::vector<double> plain = view.pixels(false, 4, 1);
    view.filtering.step = 1e-6f;
    EXPECT_EQ(rms_difference(view.pixels(true, 4, 1), plain), 0);
    for (std::uint8_t& code : view.fixture->input.images[0].rgba) {
        code = 255;
    }
    view.filtering = filtering_of(view.fixture->input, 4);
    EXPECT_FALSE(view.filtering.pyramids.any());
    EXPECT_EQ(rms_difference(view.pixels(true, 4, 1), view.pixels(false, 4, 1)), 0);
}

using formats::Material;

/// A white floor under a plate with this alpha mode.
Scene floor_and_plate(Material::AlphaMode mode, float alpha) {
    Scene scene = make_scene({make_quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}),
                              make_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2})});
    Material& plate = scene.materials.emplace_back();
    plate.base_color = {0, 0, 0};
    plate.double_sided = true;
    plate.alpha_mode = mode;
    plate.alpha = alpha;
    scene.primitives[1].material = 1;
    return scene;
}

TEST(ReferenceHoles, BlendTransmitsWhatItDoesNotCover) {
    Scene scene = floor_and_plate(Material::AlphaMode::blend, 0.3f);
    // Always the same line to the light: only the key tells its paths apart.
    scene.lights.push_back(unit_sun({0, -1, 0}));
    const auto fixture = make_fixture(std::move(scene), {});
    const bake::Moments below = look(fixture->space(), {0.2f, 0.5f, 0.1f}, {0, -1, 0}, 20000);
    EXPECT_NEAR(below.mean.x, 0.7, 3 * standard_error(below));
    // From above, the eye's ray passes the plate as well; beneath it the light passed once more.
    const bake::Moments above = look(fixture->space(), {0.2f, 2, 0.1f}, {0, -1, 0}, 20000);
    EXPECT_NEAR(above.mean.x, 0.7 * 0.7, 3 * standard_error(above));
}

TEST(ReferenceHoles, AMaskIsThereOrNot) {
    for (const float alpha : {0.4f, 0.6f}) {
        Scene scene = floor_and_plate(Material::AlphaMode::mask, alpha);
        scene.lights.push_back(unit_sun({0, -1, 0}));
        const auto fixture = make_fixture(std::move(scene), {});
        EXPECT_NEAR(look(fixture->space(), {0.2f, 2, 0.1f}, {0, -1, 0}, 4).mean.x,
                    alpha < 0.5f ? 1 : 0, 1e-5);
    }
}

// A white floor whose normal map tilts it evenly toward u, which grows toward +x.
Scene tilted_floor(std::uint8_t x, std::uint8_t z, float sign) {
    Scene scene = make_scene({make_quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100})});
    formats::Primitive& floor = scene.primitives[0];
    floor.texcoord.assign(4, {0.5f, 0.5f});
    floor.tangent.assign(4, {sign, 0, 0, sign});
    scene.images.push_back({1, 1, {x, 128, z, 255}});
    scene.materials[0].normal_image = 0;
    return scene;
}

float seen_under_sun(Scene scene, glm::vec3 travel) {
    scene.lights.push_back(unit_sun(travel));
    const auto fixture = make_fixture(std::move(scene), {});
    return static_cast<float>(look(fixture->space(), {0.2f, 2, 0.1f}, {0, -1, 0}, 16).mean.x);
}

TEST(ReferenceNormalMap, TiltsTheCosineOfASunAndKeepsTheTrianglesSides) {
    const glm::vec3 mapped = glm::normalize(glm::vec3(43, 119, 0));
    for (const float sign : {1.0f, -1.0f}) {
        const Scene scene = tilted_floor(128 + 43, 128 + 119, sign);
        for (const glm::vec3 travel : {glm::vec3(-1, -2, 0.3f), glm::vec3(1, -2, 0.3f)}) {
            const glm::vec3 normal(sign * mapped.x, mapped.y, 0);
            EXPECT_NEAR(seen_under_sun(scene, travel), glm::dot(normal, -glm::normalize(travel)),
                        1e-5f);
        }
        // Grazing from below: the tilted normal would see it, the triangle does not.
        EXPECT_EQ(seen_under_sun(scene, {-sign, 0.05f, 0}), 0);
    }
}

TEST(ReferenceNormalMap, FlatOneIsTheVerticesNormal) {
    EXPECT_NEAR(seen_under_sun(tilted_floor(128, 255, 1), {-1, -2, 0.3f}),
                seen_under_sun(tilted_floor(128, 128, 1), {-1, -2, 0.3f}), 1e-6f);
}

bake::Moments trace(const ReferenceFixture& body, bool by_sky, std::uint32_t samples) {
    const auto receivers = bake::choose_receivers(body.scene, 1, 3, std::nullopt);
    bake::Moments all;
    for (std::uint32_t s = 0; s < samples; ++s) {
        bake::RandomStream random(0, 0, s);
        const bake::PathSample path = bake::trace_receiver(body.space(), receivers[0], random);
        all.add(glm::dvec3(by_sky ? path.sky : path.radiance));
        if (path.sky != glm::vec3(0)) {
            EXPECT_NEAR(glm::length(path.to_sky), 1, 1e-5f);
        }
    }
    return all;
}

Scene make_ball(float eta) {
    Scene input = make_scene({make_sphere(2)});
    input.materials[0].medium = make_medium(3, 0.9f, 0.3f, eta);
    return input;
}

// Behind a boundary that refracts nothing else reaches the light: path by path.
TEST(SkyEnd, InTheDarkIsWorthWhatEvenLightAddsBehindARefractingBoundary) {
    const auto dark = make_fixture(make_ball(1.4f), {}),
               lit = make_fixture(make_ball(1.4f), make_white_sky());
    const bake::Moments weights = trace(*dark, true, 2000), light = trace(*lit, false, 2000);
    EXPECT_GT(light.mean.x, 0.1);
    EXPECT_NEAR(weights.mean.x, light.mean.x, 1e-6);
    EXPECT_EQ(trace(*dark, false, 100).mean.x, 0);
}

// A matched one is seen through: there even light is sampled too, and the dark counts alone.
TEST(SkyEnd, InTheDarkIsWorthWhatEvenLightAddsWhereItIsSampledToo) {
    const auto dark = make_fixture(make_ball(1), {}),
               lit = make_fixture(make_ball(1), make_white_sky());
    const bake::Moments weights = trace(*dark, true, 20000), light = trace(*lit, false, 20000),
                        part = trace(*lit, true, 20000);
    const double error = std::hypot(standard_error(weights), standard_error(light));
    EXPECT_LT(error, 0.01);
    EXPECT_NEAR(weights.mean.x, light.mean.x, 4 * error);
    EXPECT_LT(part.mean.x, 0.9 * light.mean.x);
}

}  // namespace

}  // namespace opaline::tests
