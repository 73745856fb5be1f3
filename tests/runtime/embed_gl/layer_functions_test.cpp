// What is installed for hosts that draw a cloud layer, in a host's fragment shader, beside the
// CPU's rays and pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "runtime/api_support.h"
#include "runtime/clouds/environment_at.h"
#include "runtime/clouds/see_layer.h"
#include "runtime/embed_gl/api_gl_support.h"
#include "runtime/picture/layer_pass.h"
#include "runtime/picture/software_renderer.h"
#include "tests/runtime/embed_gl/camera_rays.h"
#include "tests/runtime/embed_gl/gl_fixture.h"
#include "tests/runtime/embed_gl/host/host_layer.h"
#include "tests/support/cloud_layers.h"

namespace opaline::test {
namespace {

using formats::Rgb;
using formats::Vec3;

constexpr float kSpread = 2e-3f;

// Bumps with holes, over a ground of squares.
formats::Clouds bumpy_clouds(bool repeats, bool is_bare) {
    TestLayer layer = uneven_test_layer(48, 40);
    if (is_bare) {
        layer.radiance = {0, 0, 0};
        layer.droplets.peak_angle = 0;
    }
    // Floats round places to 0.2 mm in 4 km: of steep tops exp(-kappa * 0.2 mm) is seen.
    layer.droplets.kappa = {0.03, 0.035, 0.04};
    if (!repeats) layer.record.flags = 0;
    layer.record.wind = {20, 5};
    formats::Clouds clouds = make_test_clouds(layer, [](std::uint32_t column, std::uint32_t row) {
        return 300 * std::max(0.0, std::sin(column * 0.41) * std::cos(row * 0.37) + 0.25);
    });
    paint_squares(clouds, 180, 90);
    return clouds;
}

formats::Asset make_cloudy(bool repeats, bool is_bare) {
    formats::Asset asset = make_asset(8, 16);
    asset.clouds = bumpy_clouds(repeats, is_bare);
    return asset;
}

const formats::Environment kEvenSky = tests::lat_long_map(16, 8, [](Vec3) {
    return Rgb{1, 0.8f, 0.5f};
});
constexpr opaline_layer_sun kHostSuns[] = {{{-1, 1.2f, -1}, 0.01f, {4e4f, 3e4f, 1e4f}},
                                           {{0.1f, 0.5f, -1}, 0.02f, {1e3f, 2e3f, 3e3f}}};

opaline_layer_sky even_sky(std::uint32_t suns, double time) {
    opaline_layer_sky sky{};
    sky.struct_size = sizeof sky;
    sky.map = &kEvenSky.pixel.front().r;
    sky.width = 16;
    sky.height = 8;
    sky.suns = kHostSuns;
    sky.sun_count = suns;
    sky.time = time;
    return sky;
}

struct Viewpoint {
    const char* name;
    Vec3 eye, target;
};
constexpr Viewpoint kViewpoints[] = {{"below", {0, 2, 0}, {0, 600, -900}},
                                     {"above", {0, 3000, 0}, {600, 1000, -1500}},
                                     {"grazing", {0, 1400, 0}, {3000, 1350, -1000}},
                                     {"inside", {300, 1080, 200}, {900, 1100, -300}}};

runtime::Camera camera_at(const Viewpoint& view) {
    return {.eye = view.eye,
            .target = view.target,
            .fov_y = 60,
            .width = 24,
            .height = 18,
            .near_plane = 1};
}

runtime::LayerRay cpu_ray(Vec3 eye, const HostRay& ray, float spread) {
    return {eye + Vec3{ray.from[0], ray.from[1], ray.from[2]},
            {ray.direction[0], ray.direction[1], ray.direction[2]},
            static_cast<double>(ray.begin),
            static_cast<double>(ray.end),
            spread};
}

class EmbedGlLayer : public EmbedGl {
  protected:
    void make(const formats::Asset& asset) {
        picture_.reset();
        opaline_layer_light_release(std::exchange(layer_light_, nullptr));
        EmbedGl::make(asset);
        ASSERT_EQ(opaline_layer_light_create(host_->asset(), &layer_light_), OPALINE_OK);
    }
    void TearDown() override {
        picture_.reset();
        opaline_layer_light_release(layer_light_);
        EmbedGl::TearDown();
    }
    void show(const opaline_layer_sky& sky) {
        ASSERT_EQ(opaline_layer_light_update(layer_light_, host_->asset(), &sky, 1), OPALINE_OK)
            << opaline_last_error();
        ASSERT_EQ(opaline_gl_show_layer(gl_, host_->asset(), layer_light_), OPALINE_OK)
            << opaline_last_error();
        if (picture_) return;
        picture_.emplace(
            make_layer_picture(GetParam(), filled<opaline_gl_layer>(opaline_gl_get_layer, gl_)));
    }
    // Of what `opaline_layer_see` gives, off the CPU's by at most a share of the brightest.
    void expect_parts(Vec3 eye, const std::vector<HostRay>& rays) {
        look_from(eye);
        picture_->set_flag("wants_parts", true);
        picture_->set_number("spread", kSpread);
        const std::vector<float> drawn = picture_->draw(rays);
        float brightest = 0, thickest = 1, largest = 0, largest_through = 0, largest_distance = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const runtime::SeenLayer seen =
                runtime::see_layer(layer_light_->light, cpu_ray(eye, rays[i], kSpread));
            const Rgb all = seen.radiance + 2.0f * seen.glow;
            const float* const gl = &drawn[8 * i];
            brightest = std::max({brightest, all.r, all.g, all.b});
            thickest = std::min(thickest, seen.transmittance.g);
            largest = std::max({largest, std::abs(gl[0] - all.r), std::abs(gl[1] - all.g),
                                std::abs(gl[2] - all.b)});
            largest_through = std::max({largest_through, std::abs(gl[4] - seen.transmittance.r),
                                        std::abs(gl[6] - seen.transmittance.b),
                                        std::abs(gl[7] - seen.sun_transmittance.b)});
            const auto distance = static_cast<float>(seen.distance);
            if (1 - seen.transmittance.g < 1e-3f) continue;  // of next to nothing
            largest_distance = std::max(largest_distance, std::abs(gl[3] - distance) / distance);
        }
        std::cout << "[ agreement] " << largest / brightest << ", " << largest_through << ", "
                  << largest_distance << "\n";
        EXPECT_GT(brightest, 0.1f);
        EXPECT_LT(thickest, 0.1f);
        EXPECT_LE(largest, 1e-5f * brightest);
        EXPECT_LE(largest_through, 1e-5f);
        // Where a grazing ray meets the top is the difference of nearly equal heights, of which
        // GPUs round the last bit each in their own way.
        EXPECT_LE(largest_distance, 2e-5f);
    }
    opaline_layer_light* layer_light_ = nullptr;
    std::optional<HostPicture> picture_;
};

TEST_P(EmbedGlLayer, RaysSeeWhatTheCpuSees) {
    for (const bool is_bare : {false, true}) {
        SCOPED_TRACE(is_bare);
        make(make_cloudy(!is_bare, is_bare));
        std::uint32_t suns = 0;
        for (const Viewpoint& view : kViewpoints) {
            SCOPED_TRACE(view.name);
            // Other numbers of suns and other times with the same program.
            show(even_sky(suns % 3, 100.0 * suns));
            ++suns;
            expect_parts(view.eye, camera_rays(camera_at(view)));
        }
    }
    make(make_cloudy(true, false));
    show(even_sky(1, 0));
    // Rays from other places than the eye, with an end.
    std::vector<HostRay> rays = camera_rays(camera_at(kViewpoints[0]));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        rays[i].from[0] = static_cast<float>(i % 7) * 64;
        rays[i].from[1] = static_cast<float>(i % 5) * 16;
        if (i % 2 == 0) rays[i].end = 1500;
    }
    expect_parts(kViewpoints[0].eye, rays);
}

TEST_P(EmbedGlLayer, PixelsAreThoseOfTheRenderedPicture) {
    const formats::Asset asset = make_cloudy(true, false);
    make(asset);
    show(even_sky(0, 0));
    for (const Viewpoint& view : kViewpoints) {
        SCOPED_TRACE(view.name);
        const runtime::Camera camera = camera_at(view);
        const std::vector<HostRay> rays = camera_rays(camera);
        look_from(view.eye);
        picture_->set_flag("wants_parts", false);
        const auto spread =
            static_cast<float>(2 * runtime::camera_frame(camera).tan_half_y / camera.height);
        picture_->set_number("spread", spread);
        const std::vector<float> drawn = picture_->draw(rays);
        runtime::SoftwareOptions options;
        options.supersampling = 1;
        options.layers = &layer_light_->light;
        const auto rendered =
            runtime::render_software(asset.view(), {}, kEvenSky, {}, camera, options);
        ASSERT_TRUE(rendered.has_value());
        const runtime::LayerScene scene{layer_light_->light, kEvenSky, {}};
        int differ = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Rgb seen = runtime::see_through_layer(scene, cpu_ray(view.eye, rays[i], spread));
            EXPECT_NEAR(drawn[8 * i + 1], seen.g, 1e-5f) << i;
            // The picture has the means of corners where these agree, so few pixels are off.
            const float pixel = rendered->pixel[i].g;
            differ += std::abs(drawn[8 * i + 1] - pixel) > runtime::kCornerTolerance * pixel;
        }
        EXPECT_LE(differ, static_cast<int>(rays.size() / 20));
    }
}

std::vector<float> coefficients_of(const opaline_light* light) {
    std::vector<float> rgb(std::size_t{18} * 8 * 8);
    EXPECT_EQ(opaline_light_get_coefficients(light, rgb.data(), rgb.size()), OPALINE_OK);
    return rgb;
}

// Needs no context.
TEST(LayerLight, OfABodyIsWhatItsPointSeesAndDarkerBeneathTheClouds) {
    const EmbeddedAsset clouds(make_cloudy(true, false)), body(make_asset(8, 8));
    opaline_layer_light* layer_light = nullptr;
    ASSERT_EQ(opaline_layer_light_create(clouds.asset(), &layer_light), OPALINE_OK);
    // With a sun, then without: even light is dimmed by any cloud, a sun beside it is not.
    const float quarter[9] = {0, 0, -1, 0, 1, 0, 1, 0, 0};
    std::vector<float> brightness;
    for (const auto& [suns, height] : {std::pair{1u, 1.0f}, std::pair{1u, 5000.0f},
                                       std::pair{0u, 1.0f}, std::pair{0u, 5000.0f}}) {
        opaline_layer_sky sky = even_sky(suns, 0);
        sky.world_from_light = quarter;
        ASSERT_EQ(opaline_layer_light_update(layer_light, clouds.asset(), &sky, 1), OPALINE_OK);
        const float point[3] = {600, height, -200};
        // What stood in the light before does not stay.
        ASSERT_EQ(opaline_light_set_rotation(body.light(), quarter), OPALINE_OK);
        ASSERT_EQ(opaline_light_set_from_layer(body.light(), clouds.asset(), layer_light, point),
                  OPALINE_OK)
            << opaline_last_error();
        const formats::Environment seen = runtime::environment_at(
            {layer_light->light, layer_light->environment, layer_light->rotation},
            {point[0], point[1], point[2]}, {.threads = 1});
        const runtime::LightVector expected = runtime::project_environment(seen, 8);
        const std::vector<float> found = coefficients_of(body.light());
        const float largest = *std::max_element(expected.rgba.begin(), expected.rgba.end());
        for (std::size_t k = 0; k < found.size() / 3; ++k) {
            EXPECT_NEAR(found[3 * k + 1], expected.rgba[4 * k + 1], 1e-5f * largest) << k;
        }
        const std::size_t up = std::size_t{2} * 8 * 8;  // of the face +Y
        brightness.push_back(found[3 * up + 1]);
    }
    EXPECT_GT(brightness[2], 0);
    EXPECT_LT(brightness[2], 0.95f * brightness[3]);
    EXPECT_GT(brightness[1], 1.1f * brightness[3]);
    const float lost[3] = {0, NAN, 0}, point[3] = {0, 0, 0};
    const auto set = opaline_light_set_from_layer;
    EXPECT_THAT((Statuses{set(body.light(), clouds.asset(), layer_light, lost),
                          set(body.light(), body.asset(), layer_light, point),
                          set(nullptr, clouds.asset(), layer_light, point),
                          set(body.light(), clouds.asset(), layer_light, nullptr)}),
                testing::Each(OPALINE_INVALID_ARGUMENT));
    opaline_layer_light_release(layer_light);
}

TEST_P(EmbedGlLayer, WrongUseIsToldByStatus) {
    make(make_cloudy(true, true));
    opaline_gl_layer layer{};
    const opaline_asset* const asset = host_->asset();
    EXPECT_THAT((Statuses{opaline_gl_get_layer(gl_, &layer), opaline_gl_get_layer(gl_, nullptr),
                          opaline_gl_get_layer(nullptr, &layer),
                          opaline_gl_show_layer(nullptr, asset, layer_light_),
                          opaline_gl_show_layer(gl_, nullptr, layer_light_),
                          opaline_gl_show_layer(gl_, asset, nullptr)}),
                testing::Each(OPALINE_INVALID_ARGUMENT));
    layer.struct_size = sizeof layer;
    EXPECT_EQ(opaline_gl_get_layer(gl_, &layer), OPALINE_OK);
    EXPECT_EQ(layer.block + layer.modes + layer.table_values, 0u);
    EXPECT_EQ(opaline_asset_layer_count(asset), 1u);
    EXPECT_EQ(opaline_asset_layer_count(nullptr), 0u);
    // Before the first update the layer is black, and can be shown.
    EXPECT_EQ(opaline_gl_show_layer(gl_, asset, layer_light_), OPALINE_OK) << opaline_last_error();
    const auto refused = [&](auto change) {
        opaline_layer_sky sky = even_sky(2, 0);
        change(sky);
        return opaline_layer_light_update(layer_light_, asset, &sky, 1) == OPALINE_INVALID_ARGUMENT;
    };
    using Sky = opaline_layer_sky;
    const float black[3] = {0, 0, 0}, negative[3] = {1, -1, 1},
                skew[9] = {1, 1, 0, 0, 1, 0, 0, 0, 1};
    EXPECT_FALSE(refused([](Sky&) {}));
    EXPECT_FALSE(refused([](Sky& sky) { sky.map = nullptr; }));
    EXPECT_TRUE(refused([](Sky& sky) { sky.struct_size = 3; }));
    EXPECT_TRUE(refused([](Sky& sky) { sky.time = NAN; }));
    EXPECT_TRUE(refused([](Sky& sky) { sky.width = 0; }));
    EXPECT_TRUE(refused([](Sky& sky) { sky.width = 40000; }));
    EXPECT_TRUE(refused([](Sky& sky) { sky.is_cubemap = 1; }));
    EXPECT_TRUE(refused([](Sky& sky) { sky.is_cubemap = 2; }));
    EXPECT_TRUE(refused([](Sky& sky) { sky.suns = nullptr; }));
    EXPECT_TRUE(refused([&](Sky& sky) { sky.world_from_light = skew; }));
    EXPECT_TRUE(refused([&](Sky& sky) { sky.map = negative, sky.width = sky.height = 1; }));
    opaline_layer_sun sun = kHostSuns[0];
    std::copy(black, black + 3, sun.direction);
    EXPECT_TRUE(refused([&](Sky& sky) { sky.suns = &sun, sky.sun_count = 1; }));
    const opaline_layer_sky sky = even_sky(0, 0);
    // Another asset's; and one without a layer.
    const EmbeddedAsset other(make_cloudy(true, true)), clear_sky(make_asset(8, 8));
    opaline_layer_light *none = nullptr, *others = nullptr;
    ASSERT_EQ(opaline_layer_light_create(other.asset(), &others), OPALINE_OK);
    const auto update = opaline_layer_light_update;
    EXPECT_THAT(
        (Statuses{update(nullptr, asset, &sky, 1), update(layer_light_, nullptr, &sky, 1),
                  update(layer_light_, asset, nullptr, 1), update(layer_light_, asset, &sky, 257),
                  update(layer_light_, other.asset(), &sky, 1),
                  opaline_gl_show_layer(gl_, other.asset(), layer_light_),
                  opaline_gl_show_layer(gl_, other.asset(), others),
                  opaline_layer_light_create(clear_sky.asset(), &none),
                  opaline_layer_light_create(nullptr, &none),
                  opaline_layer_light_create(asset, nullptr)}),
        testing::Each(OPALINE_INVALID_ARGUMENT));
    opaline_layer_light_release(others);
    opaline_layer_light_release(nullptr);
    HostContext::make_none_current();
    EXPECT_EQ(opaline_gl_show_layer(gl_, asset, layer_light_), OPALINE_GL_NO_CONTEXT);
    context_->make_current();
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlLayer, kBothContexts, api_name);

}  // namespace
}  // namespace opaline::test
