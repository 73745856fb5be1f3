// What is installed for hosts that draw volumes, in a host's fragment shader, beside the functions
// of opaline.h and the picture that the renderer makes.
// What installed functions show of volumes that have light of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "runtime/api_support.h"
#include "runtime/picture/software_renderer.h"
#include "tests/runtime/embed_gl/camera_rays.h"
#include "tests/runtime/embed_gl/volume_host.h"
#include "tests/runtime/volumes/glow_support.h"

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
        make(make_puffs(far));
        HostPicture host = picture();
        std::vector<HostRay> rays = scattered_rays(600);
        // There, world coordinates of floats have 0.2 mm at best: all rays from the eye itself.
        for (HostRay& ray : rays) {
            if (far > 0) ray.from[0] = ray.from[1] = 0;
        }
        for (int step = 0; step < 3; ++step) {  // black; lit; lit by fewer coefficients a node
            const formats::Vec3 eye{far + 0.4f, 1, step == 2 ? -1.2f : -2};
            const float sky[3] = {2, 3, 4};
            if (step == 2) {
                ASSERT_EQ(opaline_light_clear(host_->light()), OPALINE_OK);
                ASSERT_EQ(opaline_light_set_lat_long(host_->light(), sky, 1, 1), OPALINE_OK);
            }
            if (step > 0) light();
            look_from(eye);
            using Seen = opaline_march_result;
            const std::vector<Seen> cpu = march(rays, eye);
            const std::vector<float> drawn = host.draw(rays);
            const float brightest = largest_of(cpu, &Seen::radiance);
            EXPECT_EQ(brightest > 0.01f, step > 0);
            EXPECT_TRUE(std::ranges::any_of(
                cpu, [](const Seen& seen) { return seen.transmittance[2] < 0.2f; }));
            expect_drawn(drawn, 0, cpu, &Seen::radiance, 1e-5f * std::max(brightest, 1e-3f));
            expect_drawn(drawn, 4, cpu, &Seen::transmittance, 1e-5f);
        }
    }
}

TEST_P(EmbedGlVolumes, PointsHaveTheCpusExtinctionAndScattering) {
    make(make_puffs(0));
    light();
    const formats::Vec3 eye{0.4f, 1, 0};
    look_from(eye);
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> value(-1, 1);
    std::vector<HostRay> places;
    for (int i = 0; i < 500; ++i) {
        places.push_back({{1.2f * value(generator), 1.2f * value(generator), 1 + value(generator)},
                          0,
                          {0.6f, 0, 0.8f},
                          0});
    }
    using Point = opaline_sample_result;
    const std::vector<Point> cpu = sample_points(host_->asset(), volume_light_, places, eye);
    HostPicture host = picture();
    host.set_flag("is_point", true);
    const std::vector<float> drawn = host.draw(places);
    const float thickest = largest_of(cpu, &Point::extinction),
                brightest = largest_of(cpu, &Point::scattered);
    EXPECT_GT(thickest, 1);
    EXPECT_GT(brightest, 0.1f);
    expect_drawn(drawn, 0, cpu, &Point::extinction, 1e-5f * thickest);
    expect_drawn(drawn, 4, cpu, &Point::scattered, 1e-5f * brightest);
}

TEST_P(EmbedGlVolumes, PixelsAreThoseOfTheRenderedPicture) {
    const formats::Asset asset = make_puffs(0);
    make(asset);
    light();
    const runtime::Camera camera{
        .eye = {0.4f, 1.1f, -3}, .target = {0.5f, 1, 1}, .width = 24, .height = 20};
    runtime::SoftwareOptions options;
    options.supersampling = 1;
    options.background = false;
    options.volumes = &volume_light_->light;
    const auto rendered = runtime::render_software(asset.view(), {}, {}, {}, camera, options);
    ASSERT_TRUE(rendered.has_value());
    look_from(camera.eye);
    HostPicture host = picture();
    const std::vector<float> drawn = host.draw(camera_rays(camera));
    float brightest = 0;
    for (const formats::Rgb& pixel : rendered->pixel)
        brightest = std::max(brightest, pixel.g);
    EXPECT_GT(brightest, 0.01f);
    for (std::size_t i = 0; i < rendered->pixel.size(); ++i) {
        EXPECT_NEAR(drawn[8 * i + 1], rendered->pixel[i].g, 1e-5f * brightest) << i;
    }
}

TEST_P(EmbedGlVolumes, WrongUseIsToldByStatus) {
    make(make_puffs(0));
    opaline_gl_volumes volumes{};
    const EmbeddedAsset other(make_puffs(0));
    opaline_volume_light* others = nullptr;
    ASSERT_EQ(opaline_volume_light_create(other.asset(), &others), OPALINE_OK);
    EXPECT_THAT(
        (Statuses{opaline_gl_get_volumes(gl_, &volumes), opaline_gl_get_volumes(gl_, nullptr),
                  opaline_gl_get_volumes(nullptr, &volumes),
                  opaline_gl_light_volumes(nullptr, volume_light_),
                  opaline_gl_light_volumes(gl_, nullptr), opaline_gl_light_volumes(gl_, others)}),
        testing::Each(OPALINE_INVALID_ARGUMENT));
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

INSTANTIATE_TEST_SUITE_P(On, EmbedGlVolumes, kBothContexts, api_name);

// The second is fire, also where there is no smoke.
formats::Asset make_burning_puffs() {
    formats::Asset asset = make_asset(8, 8);
    formats::append_emitter(asset.emitters, "fire");
    asset.volumes = make_volumes(8);
    add_volume(asset.volumes, puff(0, 4, 0));
    const TestVolume burning = puff(0.7f, 4, 0);
    add_volume(asset.volumes, burning);
    add_glow(asset.volumes, burning,
             [](float i, float j, float k) {
                 const float r2 = i * i + (j - 16) * (j - 16) + (k - 24) * (k - 24);
                 return std::exp(-r2 / 25) * formats::Rgb{6, 3, 1};
             },
             {0.5f, 0.3f, 0.1f});
    return asset;
}

TEST_P(EmbedGlVolumes, FireShinesAlongRaysAndAtPointsAsOnTheCpuInItsEmittersColour) {
    make(make_burning_puffs());
    EXPECT_EQ(objects().glows, 1u);
    HostPicture host = picture();
    const formats::Vec3 eye{0.4f, 1.2f, -2};
    look_from(eye);
    const std::vector<HostRay> rays = scattered_rays(300);
    const float color[3] = {1, 0.5f, 3};
    ASSERT_EQ(opaline_light_set_emitter(host_->light(), 0, color), OPALINE_OK);
    float scattered_alone = 0;
    for (const std::uint32_t flags : {std::uint32_t{OPALINE_SHADE_WITHOUT_EMISSION}, 0u}) {
        light(flags);
        const auto cpu = march(rays, eye);
        const float brightest = largest_of(cpu, &opaline_march_result::radiance);
        expect_drawn(host.draw(rays), 0, cpu, &opaline_march_result::radiance, 1e-5f * brightest);
        EXPECT_GT(brightest, 1.5f * scattered_alone);
        scattered_alone = brightest;
    }
    std::vector<HostRay> places;
    for (int i = 0; i < 200; ++i) {
        const float at = 0.01f * static_cast<float>(i);
        places.push_back({{0.5f * at, 0.7f - 0.3f * at, 2 + at}, 0, {0, 0, -1}, 0});
    }
    const auto cpu = sample_points(host_->asset(), volume_light_, places, eye);
    host.set_flag("is_point", true);
    expect_drawn(host.draw(places), 4, cpu, &opaline_sample_result::scattered, 5e-5f);  // of 6
    EXPECT_TRUE(std::ranges::any_of(cpu, [](const opaline_sample_result& point) {
        return point.extinction[0] == 0 && point.scattered[0] > 0.1f;
    }));  // it glows without smoke
}

// One that was built before volumes had light of their own.
TEST_P(EmbedGlVolumes, AnEarlierHostSeesFireWithoutItsOwnLight) {
    make(make_burning_puffs());
    light();
    opaline_gl_volumes early{};
    early.struct_size = offsetof(opaline_gl_volumes, glows);
    early.glows = 7;
    ASSERT_EQ(opaline_gl_get_volumes(gl_, &early), OPALINE_OK) << opaline_last_error();
    EXPECT_EQ(early.struct_size, offsetof(opaline_gl_volumes, glows));
    EXPECT_EQ(early.glows, 7u);  // behind what it knows
    EXPECT_EQ(early.block, objects().block);
    early.glows = 0;  // as in a host that knows nothing of it
    HostPicture host = make_volume_picture(GetParam(), early);
    const formats::Vec3 eye{0.4f, 1.2f, -2};
    look_from(eye);
    const std::vector<HostRay> rays = scattered_rays(100);
    const std::vector<float> drawn = host.draw(rays);
    ASSERT_EQ(opaline_volume_light_update(volume_light_, host_->asset(), host_->light(),
                                          OPALINE_SHADE_WITHOUT_EMISSION, 0),
              OPALINE_OK);
    const auto cpu = march(rays, eye);
    const float brightest = largest_of(cpu, &opaline_march_result::radiance);
    EXPECT_GT(brightest, 0.01f);
    expect_drawn(drawn, 0, cpu, &opaline_march_result::radiance, 1e-5f * brightest);
}

}  // namespace

}  // namespace opaline::test
