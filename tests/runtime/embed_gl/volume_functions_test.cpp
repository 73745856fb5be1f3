// What is installed for hosts that draw volumes, in a host's fragment shader, beside the functions
// of opaline.h and the picture that the renderer makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

#include "runtime/api_support.h"
#include "runtime/picture/software_renderer.h"
#include "tests/runtime/embed_gl/embedded_asset.h"
#include "tests/runtime/embed_gl/volume_host.h"
#include "tests/runtime/volumes/synthetic_volume.h"

namespace opaline::test {
namespace {

// Two that overlap, one with a phase function that suns meet as it is; far from the origin too.
formats::Asset make_puffs(float far) {
    formats::Asset asset = make_asset(8, 8);
    asset.volumes = make_volumes(8);
    add_volume(asset.volumes, puff(far, 4, 0));
    add_volume(asset.volumes, puff(far + 0.7f, 25, 0.8f));
    return asset;
}

TEST_P(EmbedGlVolumes, RaysSeeWhatTheCpuMarches) {
    for (const float far : {0.0f, 3000.0f}) {
        if (gl_ != nullptr) TearDown();
        make(make_puffs(far));
        HostPicture host = picture();
        std::vector<HostRay> rays = scattered_rays(600);
        // There, world coordinates of floats have 0.2 mm at best: all rays from the eye itself.
        for (HostRay& ray : rays) {
            if (far > 0) ray.from[0] = ray.from[1] = 0;
        }
        for (int step = 0; step < 3; ++step) {  // black; lit; lit by fewer coefficients a node
            const float eye[3] = {far + 0.4f, 1, step == 2 ? -1.2f : -2};
            const float sky[3] = {2, 3, 4};
            if (step == 2) {
                ASSERT_EQ(opaline_light_clear(host_->light()), OPALINE_OK);
                ASSERT_EQ(opaline_light_set_lat_long(host_->light(), sky, 1, 1), OPALINE_OK);
            }
            if (step > 0) light();
            ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
            const std::vector<opaline_march_result> cpu = march(rays, eye);
            const std::vector<float> drawn = host.draw(rays);
            float brightest = 1e-30f, largest = 0, largest_left = 0, darkest = 1;
            for (const opaline_march_result& result : cpu) {
                brightest = std::max(brightest, result.radiance[0]);
            }
            for (std::size_t i = 0; i < cpu.size(); ++i) {
                for (std::size_t b = 0; b < 3; ++b) {
                    largest = std::max(largest, std::abs(drawn[8 * i + b] - cpu[i].radiance[b]));
                    const float left = drawn[8 * i + 4 + b] - cpu[i].transmittance[b];
                    largest_left = std::max(largest_left, std::abs(left));
                    darkest = std::min(darkest, cpu[i].transmittance[b]);
                }
            }
            std::cout << "[ agreement] " << largest / brightest << ", " << largest_left << "\n";
            EXPECT_LT(darkest, 0.2f);
            EXPECT_EQ(brightest > 0.01f, step > 0);
            EXPECT_LE(largest, 1e-5f * std::max(brightest, 1e-3f));
            EXPECT_LE(largest_left, 1e-5f);
        }
    }
}

TEST_P(EmbedGlVolumes, PointsHaveTheCpusExtinctionAndScattering) {
    make(make_puffs(0));
    light();
    const float eye[3] = {0.4f, 1, 0};
    ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> value(-1, 1);
    std::vector<HostRay> places;
    for (int i = 0; i < 500; ++i) {
        places.push_back({{1.2f * value(generator), 1.2f * value(generator), 1 + value(generator)},
                          0,
                          {0.6f, 0, 0.8f},
                          0});
    }
    const std::vector<opaline_sample_result> cpu =
        sample_points(host_->asset(), volume_light_, places, eye);
    HostPicture host = picture();
    host.set_flag("is_point", true);
    const std::vector<float> drawn = host.draw(places);
    float thickest = 0, brightest = 0;
    for (const opaline_sample_result& result : cpu) {
        thickest = std::max(thickest, result.extinction[2]);
        brightest = std::max(brightest, result.scattered[2]);
    }
    EXPECT_GT(thickest, 1);
    EXPECT_GT(brightest, 0.1f);
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_NEAR(drawn[8 * i + b], cpu[i].extinction[b], 1e-5f * thickest) << i;
            EXPECT_NEAR(drawn[8 * i + 4 + b], cpu[i].scattered[b], 1e-5f * brightest) << i;
        }
    }
}

TEST_P(EmbedGlVolumes, PixelsAreThoseOfTheRenderedPicture) {
    const formats::Asset asset = make_puffs(0);
    make(asset);
    light();
    runtime::Camera camera;
    camera.eye = {0.4f, 1.1f, -3};
    camera.target = {0.5f, 1, 1};
    camera.width = 24;
    camera.height = 20;
    runtime::SoftwareOptions options;
    options.supersampling = 1;
    options.background = false;
    options.volumes = &volume_light_->light;
    const auto rendered = runtime::render_software(asset.view(), {}, {}, {}, camera, options);
    ASSERT_TRUE(rendered.has_value());
    const float eye[3] = {camera.eye.x, camera.eye.y, camera.eye.z};
    ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
    const runtime::CameraFrame frame = runtime::camera_frame(camera);
    std::vector<HostRay> rays;
    for (std::uint32_t i = 0; i < camera.width * camera.height; ++i) {
        const formats::Vec3 d =
            runtime::view_ray(camera, frame, i % camera.width + 0.5, i / camera.width + 0.5);
        rays.push_back({{0, 0, 0}, camera.near_plane, {d.x, d.y, d.z}, 1e30f});
    }
    HostPicture host = picture();
    const std::vector<float> drawn = host.draw(rays);
    float brightest = 0;
    for (const formats::Rgb& pixel : rendered->pixel)
        brightest = std::max(brightest, pixel.g);
    EXPECT_GT(brightest, 0.01f);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_NEAR(drawn[8 * i + 1], rendered->pixel[i].g, 1e-5f * brightest) << i;
    }
}

TEST_P(EmbedGlVolumes, WrongUseIsToldByStatus) {
    make(make_puffs(0));
    opaline_gl_volumes volumes{};
    EXPECT_EQ(opaline_gl_get_volumes(gl_, &volumes), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_volumes(gl_, nullptr), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_volumes(nullptr, &volumes), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_light_volumes(nullptr, volume_light_), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_light_volumes(gl_, nullptr), OPALINE_INVALID_ARGUMENT);
    const EmbeddedAsset other(make_puffs(0));
    opaline_volume_light* others = nullptr;
    ASSERT_EQ(opaline_volume_light_create(other.asset(), &others), OPALINE_OK);
    EXPECT_EQ(opaline_gl_light_volumes(gl_, others), OPALINE_INVALID_ARGUMENT);
    opaline_volume_light_release(others);
    // Without the flag there are none, with five there is no handle.
    opaline_gl* without = nullptr;
    ASSERT_EQ(opaline_gl_create(host_->asset(), load_gl, 0, &without), OPALINE_OK);
    EXPECT_EQ(opaline_gl_light_volumes(without, volume_light_), OPALINE_OK);
    volumes.struct_size = sizeof volumes;
    EXPECT_EQ(opaline_gl_get_volumes(without, &volumes), OPALINE_OK);
    EXPECT_EQ(volumes.count + volumes.block + volumes.node_light, 0u);
    EXPECT_EQ(opaline_gl_release(without), OPALINE_OK);
    formats::Asset many = make_asset(8, 8);
    many.volumes = make_volumes(8);
    for (int i = 0; i < 5; ++i)
        add_volume(many.volumes, puff(static_cast<float>(i), 4, 0));
    const EmbeddedAsset five(many);
    opaline_gl* none = nullptr;
    EXPECT_EQ(opaline_gl_create(five.asset(), load_gl, OPALINE_GL_WITH_VOLUMES, &none),
              OPALINE_GL_REFUSED);
    EXPECT_EQ(none, nullptr);
    EXPECT_EQ(opaline_gl_create(five.asset(), load_gl, 0, &none), OPALINE_OK);
    EXPECT_EQ(opaline_gl_release(none), OPALINE_OK);
    HostContext::make_none_current();
    EXPECT_EQ(opaline_gl_light_volumes(gl_, volume_light_), OPALINE_GL_NO_CONTEXT);
    context_->make_current();
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlVolumes, testing::Values(HostApi::desktop_43, HostApi::es_31),
                         api_name);

}  // namespace
}  // namespace opaline::test
