// Emitters through the C interface.
// Volumes that are emitters, through the C interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "formats/opal/emitters.h"
#include "tests/formats/opal/emitter_fixture.h"
#include "tests/runtime/api_test_support.h"
#include "tests/runtime/api_volumes_support.h"
#include "tests/runtime/volumes/glow_support.h"

namespace opaline::runtime {
namespace {

class ApiEmitters : public testing::Test, protected tests::LoadedAsset {
  protected:
    ApiEmitters() : LoadedAsset(tests::make_emitter_asset()) {}
    opaline_status set(std::uint32_t emitter, const float* color) const {
        return opaline_light_set_emitter(light.get(), emitter, color);
    }
};

TEST_F(ApiEmitters, AreNamed) {
    EXPECT_EQ(opaline_asset_emitter_count(nullptr), 0u);
    ASSERT_EQ(opaline_asset_emitter_count(asset.get()), 2u);
    opaline_emitter_info info{};
    info.struct_size = sizeof info;
    ASSERT_EQ(opaline_asset_emitter(asset.get(), 1, &info), OPALINE_OK);
    EXPECT_STREQ(info.name, "Panel");
    EXPECT_EQ(opaline_asset_emitter(asset.get(), 2, &info), OPALINE_INVALID_ARGUMENT);
    info.struct_size = 1;
    EXPECT_EQ(opaline_asset_emitter(asset.get(), 0, &info), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_asset_emitter(asset.get(), 0, nullptr), OPALINE_INVALID_ARGUMENT);
}

TEST_F(ApiEmitters, SurfacesSayWhatTheySendOut) {
    opaline_primitive_emission emission{};
    emission.struct_size = sizeof emission;
    ASSERT_EQ(opaline_asset_primitive_emission(asset.get(), 0, &emission), OPALINE_OK);
    EXPECT_EQ(emission.emitter, 1u);
    EXPECT_EQ(emission.radiance[2], 25);
    ASSERT_EQ(opaline_asset_primitive_emission(asset.get(), 1, &emission), OPALINE_OK);
    EXPECT_EQ(emission.emitter, OPALINE_NO_EMITTER);
    EXPECT_EQ(opaline_asset_primitive_emission(asset.get(), 2, &emission),
              OPALINE_INVALID_ARGUMENT);
}

TEST_F(ApiEmitters, AreLitUntilTheyAreSwitchedOff) {
    const std::vector<float> on = shaded();  // a new light is black
    EXPECT_GT(on[0], 1);
    const float half[3] = {0.5f, 0.5f, 0.5f}, off[3] = {0, 0, 0};
    ASSERT_EQ(set(0, half), OPALINE_OK);
    ASSERT_EQ(set(1, half), OPALINE_OK);
    const std::vector<float> dimmed = shaded();
    for (std::size_t i = 0; i < on.size(); ++i) {
        EXPECT_NEAR(dimmed[i], on[i] / 2, 1e-5f * on[i]);
    }
    const std::vector<float> reflected = shaded(OPALINE_SHADE_WITHOUT_EMISSION);
    EXPECT_LT(reflected[0], dimmed[0]);
    ASSERT_EQ(set(0, off), OPALINE_OK);
    ASSERT_EQ(set(1, off), OPALINE_OK);
    ASSERT_EQ(opaline_light_clear(light.get()), OPALINE_OK);  // keeps them off
    EXPECT_THAT(shaded(), testing::Each(0));
}

TEST_F(ApiEmitters, RefuseWhatIsNoColourAndLightsOfOtherAssets) {
    const float color[3] = {1, 1, 1};
    EXPECT_EQ(opaline_light_set_emitter(nullptr, 0, color), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(set(2, color), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(set(0, nullptr), OPALINE_INVALID_ARGUMENT);
    for (const float bad : {-1.0f, std::numeric_limits<float>::infinity(), NAN}) {
        const float wrong[3] = {1, bad, 1};
        EXPECT_EQ(set(0, wrong), OPALINE_INVALID_ARGUMENT);
    }
    const LoadedAsset other(tests::make_small_asset());
    std::vector<float> out(3 * 8);
    EXPECT_EQ(opaline_shade(asset.get(), other.light.get(), 0, out.data(), out.size()),
              OPALINE_INVALID_ARGUMENT);
    EXPECT_THAT(opaline_last_error(), testing::HasSubstr("number of emitters"));
}

using formats::Rgb;

TEST(ApiGlow, VolumesThatAreEmittersAreSwitchedLikeLamps) {
    formats::Asset source = test::make_smoky_asset(test::kSmokySize);
    formats::append_emitter(source.emitters, "fire");
    test::add_glow(source.volumes, test::make_smoke(0.7f),
                   [](float, float, float) {
                       return Rgb{4, 2, 1};
                   },
                   {1, 1, 1});
    const test::VolumeHandles handles(source);
    const opaline_march_ray ray{
        {1.5f, 0.8f, -1}, {0, 0, 1}, 0, std::numeric_limits<float>::infinity()};
    const auto see = [&](std::uint32_t flags, const std::array<float, 3>& color) {
        EXPECT_EQ(opaline_light_set_emitter(handles.light.get(), 0, color.data()), OPALINE_OK);
        EXPECT_EQ(opaline_volume_light_update(handles.volume_light.get(), handles.asset.get(),
                                              handles.light.get(), flags, 1),
                  OPALINE_OK)
            << opaline_last_error();
        opaline_march_result seen{};
        EXPECT_EQ(opaline_volumes_march(handles.asset.get(), handles.volume_light.get(), nullptr,
                                        &ray, 1, &seen),
                  OPALINE_OK);
        return seen.radiance[0];
    };
    const float all = see(0, {1, 1, 1}), scattered = see(OPALINE_SHADE_WITHOUT_EMISSION, {1, 1, 1});
    EXPECT_GT(scattered, 0);
    EXPECT_GT(all, 2 * scattered);
    EXPECT_NEAR(see(0, {3, 1, 1}), 3 * all, 1e-4f * all);
    EXPECT_EQ(see(0, {0, 0, 0}), 0);
    // A point shows the same light.
    see(0, {1, 1, 1});
    const opaline_sample_point point{{1.5f, 0.8f, 0.8f}, {0, 0, -1}};
    opaline_sample_result sample{};
    ASSERT_EQ(
        opaline_volumes_sample(handles.asset.get(), handles.volume_light.get(), &point, 1, &sample),
        OPALINE_OK);
    const Rgb extinction{sample.extinction[0], sample.extinction[1], sample.extinction[2]};
    EXPECT_NEAR(sample.scattered[0], 4 + 0.9f * 0.2820948f * extinction.r, 0.02f);
}

}  // namespace

}  // namespace opaline::runtime
