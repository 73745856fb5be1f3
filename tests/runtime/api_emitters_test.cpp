// Emitters through the C interface.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "tests/formats/opal/emitter_fixture.h"
#include "tests/runtime/api_test_support.h"

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

}  // namespace
}  // namespace opaline::runtime
