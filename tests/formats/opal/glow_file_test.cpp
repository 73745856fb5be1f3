// Light of volumes that is written comes back; damaged or impossible light is refused.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "formats/opal/half.h"
#include "tests/formats/opal/glow_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;
using tests::make_glow_asset;

TEST(SharedExponent, EachChannelErrsByLittleOfTheLargest) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> exponent(-15, 15), mantissa(0, 1);
    for (int i = 0; i < 20000; ++i) {
        const float scale = std::exp2(exponent(generator));
        const Rgb c{scale * mantissa(generator), scale * mantissa(generator),
                    scale * mantissa(generator)};
        const float most = std::max({c.r, c.g, c.b});
        const Rgb back = unpack_shared(pack_shared(c));
        const float allowed = most * 0x1p-9f + 0x1p-25f;
        EXPECT_NEAR(back.r, c.r, allowed);
        EXPECT_NEAR(back.g, c.g, allowed);
        EXPECT_NEAR(back.b, c.b, allowed);
    }
    for (const Rgb exact :
         {Rgb{0, 0, 0}, Rgb{1, 0.5f, 0.25f}, Rgb{kLargestShared, 0, 128}, Rgb{0x1p-24f, 0, 0}}) {
        EXPECT_EQ(unpack_shared(pack_shared(exact)), exact);
    }
    EXPECT_EQ(unpack_shared(pack_shared({1e30f, -1, 0})), (Rgb{kLargestShared, 0, 0}));
    EXPECT_EQ(unpack_shared(pack_shared({1.9999f, 0, 0})), (Rgb{2, 0, 0}));
}

TEST(GlowFile, ReturnsEveryValueItWasGivenAndIsAbsentWithoutLight) {
    const Asset asset = make_glow_asset();
    const tests::StoredAsset stored(asset);
    const GlowView& glow = stored.view().volumes.glow;
    tests::expect_same_bytes(glow.record, asset.volumes.glow.record);
    tests::expect_same_bytes(glow.brick, asset.volumes.glow.brick);
    tests::expect_same_bytes(glow.code, asset.volumes.glow.code);
    tests::expect_same_bytes(glow.value, asset.volumes.glow.value);
    EXPECT_EQ(stored.version_of(kGlowSection), 1u);
    ASSERT_EQ(glow.of_volume(1).size(), 1u);
    EXPECT_EQ(glow.of_volume(1).data(), &glow.record[1]);
    EXPECT_EQ(glow.own_of(0), &glow.record[0]);
    EXPECT_EQ(glow.own_of(1), nullptr);
    EXPECT_TRUE(glow.of_volume(2).empty());

    EXPECT_EQ(tests::StoredAsset(tests::make_volume_asset()).version_of(kGlowSection), 0u);
}

template <class Change>
std::string glow_fault(Change change, Checks checks = Checks::structure) {
    return tests::fault_after(
        make_glow_asset(), [&](Asset& asset) { change(asset.volumes.glow); }, checks);
}

TEST(GlowFile, RecordsOfWhatIsNotThereAreRefused) {
    EXPECT_EQ(glow_fault([](Glow&) {}), "");
    const char* const absent = "section GLOW, record 1: its volume or emitter does not exist";
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[1].volume = 2; }), HasSubstr(absent));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[1].emitter = 1; }), HasSubstr(absent));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[1].volume = 0; }), HasSubstr("stands twice"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.brick[0] = 2; }), HasSubstr("a brick that its volume"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].first_brick = 1; }), HasSubstr("lie outside"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].terms = 9; }), HasSubstr("overlap"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[1].first_value = 0; }), HasSubstr("overlap"));
}

TEST(GlowFile, NumbersThatAreNoneAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].terms = 2; }), HasSubstr("2 terms"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].value_scale = -1; }), HasSubstr("scales"));
    EXPECT_THAT(glow_fault([&](Glow& g) { g.record[0].code_scale = nan; }), HasSubstr("scales"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.record[0].code_scale = 3e38f; }), HasSubstr("scales"));
    EXPECT_THAT(glow_fault([](Glow& g) { g.value[5] = 0x7c00; }, Checks::full),
                HasSubstr("section GLOW, value 5: it is not finite"));
    EXPECT_EQ(glow_fault([](Glow& g) { g.value[5] = 0x7c00; }), "");
}

}  // namespace
}  // namespace opaline::formats
