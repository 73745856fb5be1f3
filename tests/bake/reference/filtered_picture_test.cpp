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

}  // namespace
}  // namespace opaline::tests
