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

float brightest_of(const std::vector<opaline_march_result>& seen) {
    float brightest = 0;
    for (const opaline_march_result& result : seen) {
        brightest = std::max(brightest, result.radiance[0]);
    }
    return brightest;
}

TEST_P(EmbedGlVolumes, FireShinesAlongRaysAndAtPointsAsOnTheCpuInItsEmittersColour) {
    make(make_burning_puffs());
    EXPECT_EQ(objects().glows, 1u);
    HostPicture host = picture();
    const float eye[3] = {0.4f, 1.2f, -2};
    ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
    const std::vector<HostRay> rays = scattered_rays(300);
    const float color[3] = {1, 0.5f, 3};
    ASSERT_EQ(opaline_light_set_emitter(host_->light(), 0, color), OPALINE_OK);
    float scattered_alone = 0;
    for (const std::uint32_t flags : {std::uint32_t{OPALINE_SHADE_WITHOUT_EMISSION}, 0u}) {
        light(flags);
        const std::vector<opaline_march_result> cpu = march(rays, eye);
        const std::vector<float> drawn = host.draw(rays);
        const float brightest = brightest_of(cpu);
        for (std::size_t i = 0; i < cpu.size(); ++i) {
            for (std::size_t b = 0; b < 3; ++b) {
                EXPECT_NEAR(drawn[8 * i + b], cpu[i].radiance[b], 1e-5f * brightest) << i;
            }
        }
        EXPECT_GT(brightest, 1.5f * scattered_alone);
        scattered_alone = brightest;
    }
    std::vector<HostRay> places;
    for (int i = 0; i < 200; ++i) {
        const float at = 0.01f * static_cast<float>(i);
        places.push_back({{0.5f * at, 0.7f - 0.3f * at, 2 + at}, 0, {0, 0, -1}, 0});
    }
    const std::vector<opaline_sample_result> cpu =
        sample_points(host_->asset(), volume_light_, places, eye);
    host.set_flag("is_point", true);
    const std::vector<float> drawn = host.draw(places);
    bool glows_without_smoke = false;
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        glows_without_smoke =
            glows_without_smoke || (cpu[i].extinction[0] == 0 && cpu[i].scattered[0] > 0.1f);
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_NEAR(drawn[8 * i + 4 + b], cpu[i].scattered[b], 5e-5f) << i;  // of 6
        }
    }
    EXPECT_TRUE(glows_without_smoke);
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
    const float eye[3] = {0.4f, 1.2f, -2};
    ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
    const std::vector<HostRay> rays = scattered_rays(100);
    const std::vector<float> drawn = host.draw(rays);
    ASSERT_EQ(opaline_volume_light_update(volume_light_, host_->asset(), host_->light(),
                                          OPALINE_SHADE_WITHOUT_EMISSION, 0),
              OPALINE_OK);
    const std::vector<opaline_march_result> cpu = march(rays, eye);
    const float brightest = brightest_of(cpu);
    EXPECT_GT(brightest, 0.01f);
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        EXPECT_NEAR(drawn[8 * i], cpu[i].radiance[0], 1e-5f * brightest) << i;
    }
}

}  // namespace
}  // namespace opaline::test
