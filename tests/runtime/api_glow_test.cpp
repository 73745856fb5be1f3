// Volumes that are emitters, through the C interface.
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "formats/opal/emitters.h"
#include "tests/runtime/api_volumes_support.h"
#include "tests/runtime/volumes/glow_support.h"

namespace opaline::runtime {
namespace {

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
