// What installed functions show of volumes that have light of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "tests/runtime/embed_gl/volume_host.h"
#include "tests/runtime/volumes/glow_support.h"

namespace opaline::test {
namespace {

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
