// Normal maps that are written come back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include <limits>

#include "tests/formats/opal/normal_map_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;
using tests::make_normal_map_asset;

TEST(NormalMapsFile, WhatIsWrittenComesBackAndOtherSurfacesHaveNone) {
    const Asset asset = make_normal_map_asset();
    const tests::StoredAsset stored(asset);
    const NormalMapsView& maps = stored.view().normal_maps;
    tests::expect_same_bytes(maps.record, asset.normal_maps.record);
    tests::expect_same_bytes(maps.tangent, asset.normal_maps.tangent);
    EXPECT_EQ(maps.of(1)->wrap_v, Wrap::clamp);
    EXPECT_EQ(maps.of(0), nullptr);
    EXPECT_EQ(tests::StoredAsset(tests::make_small_asset()).version_of(kNormSection), 0u);
}

TEST(NormalMapsFile, TangentsKeepTheirDirectionToFifteenSecondsOfArc) {
    for (int i = 0; i < 500; ++i) {
        const float z = -1 + 0.004f * static_cast<float>(i), angle = 2.4f * static_cast<float>(i);
        const float side = std::sqrt(1 - z * z);
        const Vec3 direction{side * std::cos(angle), side * std::sin(angle), z};
        const auto decoded = decode_tangent(encode_tangent(direction, i % 2 == 0 ? 1.0f : -1.0f));
        EXPECT_LT(length(cross(decoded.direction, direction)), 7.3e-5f) << i;
        EXPECT_GT(dot(decoded.direction, direction), 0.9999f);
        EXPECT_EQ(decoded.sign, i % 2 == 0 ? 1 : -1);
    }
    EXPECT_EQ(decode_tangent(encode_tangent({}, 0)).direction, Vec3{});
}

TEST(NormalMapsFile, SharesOfThinWalledSurfacesComeBackInALaterVersion) {
    const Asset asset = tests::make_mapped_sheet_asset();
    const tests::StoredAsset stored(asset);
    const SheetShares shares = sheet_shares_of(stored.view().normal_maps.record[0]);
    EXPECT_EQ(shares.reflect, (Rgb{0.5f, 0.25f, 0}));
    EXPECT_EQ(shares.transmit, (Rgb{0.25f, 0.75f, 1}));
    EXPECT_EQ(stored.version_of(kNormSection), 2u);
    EXPECT_EQ(tests::StoredAsset(make_normal_map_asset()).version_of(kNormSection), 1u);
    tests::expect_refused(
        asset, "NORM",
        {{[](Asset& a) { a.normal_maps.record[0].reserved[1] = 0x3c010000u; }, "not one of this"},
         {[](Asset& a) { a.normal_maps.record[0].reserved[2] = 0x8001u; }, "not one of this"}});
}

TEST(NormalMapsFile, WhatCannotBeIsRefusedByName) {
    const std::vector<tests::Impossible> cases{
        {[](Asset& a) { a.normal_maps.record.push_back(a.normal_maps.record[0]); }, "stands twice"},
        {[](Asset& a) { a.normal_maps.record[0].primitive = 2; }, "does not exist"},
        {[](Asset& a) { a.normal_maps.record[0].primitive = 0xffffffffu; }, "does not exist"},
        {[](Asset& a) { a.normal_maps.record[0].image = 1; }, "not there"},
        {[](Asset& a) { a.normal_maps.record[0].image = kNoImage; }, "not there"},
        {[](Asset& a) { a.normal_maps.record[0].wrap_u = Wrap{3}; }, "wrap mode"},
        {[](Asset& a) { a.normal_maps.record[0].scale = std::numeric_limits<float>::infinity(); },
         "scale"},
        {[](Asset& a) { a.normal_maps.record[0].scale = -1001; }, "scale"},
        {[](Asset& a) { a.normal_maps.record[0].reserved[2] = 1; }, "not one of this version"},
        {[](Asset& a) { a.normal_maps.tangent.pop_back(); }, "a tangent for each vertex"},
    };
    tests::expect_refused(make_normal_map_asset(), "NORM", cases, Checks::full);
}

}  // namespace
}  // namespace opaline::formats
